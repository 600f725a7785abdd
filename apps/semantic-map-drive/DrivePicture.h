#pragma once
#include <opencv2/core.hpp>

#include "DriveLoop.h"

namespace semantic_map_drive {

/** Seconds, meters, speed, and where to. */
std::string caption(const DriveLoop& loop);

/** The drive from above: the robot's map in its classes' colors, start and goal, what is left of
 * the path, the driven track, and the robot. One picture is like the other in place and size. */
class DrivePicture {
 public:
  /** \param size longer edge of the map's part, pixels */
  DrivePicture(const mrpt::math::TPose2D& start, const mrpt::math::TPose2D& goal, int size = 560);

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

  double m_left, m_top, m_scale;  ///< meters, meters, pixels per meter
  cv::Size m_size;
};

}  // namespace semantic_map_drive
