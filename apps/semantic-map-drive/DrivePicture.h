#pragma once
#include <opencv2/core.hpp>

#include "simulated_drive/DriveLoop.h"

namespace semantic_map_drive {

using namespace simulated_drive;

/** Seconds, meters, speed, and where to. */
std::string caption(const DriveLoop& loop);

/** The drive from above: the robot's map in its classes' colors, start and goal, what is left of
 * the path, the driven track, and the robot. One picture is like the other in place and size. */
class DrivePicture {
 public:
  /** \param size longer edge of the map's part, pixels */
  DrivePicture(const mrpt::math::TPose2D& start, const mrpt::math::TPose2D& goal, int size = 560);
  /** Makes room for a drive's track, too: another place and size from here on. */
  void include(const DriveRecord& record);

  /** BGR. */
  cv::Mat draw(const DriveLoop& loop) const;
  /** The same with another drive's track. */
  void addTrack(cv::Mat& picture, const DriveRecord& record, const cv::Scalar& color) const;

 private:
  cv::Point pixel(double x, double y) const;
  void drawMap(cv::Mat& picture, const semantic_octree::SemanticOcTree& map, double top) const;
  void drawRoute(cv::Mat& picture, const DriveLoop& loop) const;
  void drawPose(cv::Mat& picture, const mrpt::math::TPose2D& pose, const cv::Scalar& color) const;
  void drawRobot(cv::Mat& picture, const DriveLoop& loop) const;

  void include(const mrpt::math::TPose2D& pose, double margin);
  void fit();

  int m_longerEdge;
  double m_left, m_right, m_bottom, m_top;  ///< meters
  double m_scale = 0;                       ///< pixels per meter
  cv::Size m_size;
};

}  // namespace semantic_map_drive
