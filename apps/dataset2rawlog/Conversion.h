#pragma once
#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/LabelImage.h>
#include <labeled_cloud/Rawlogs.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semantic_types/ClassTable.h>
#include <strict_files/TextFile.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "Terminal.h"
#include "label_noise/LabelNoise.h"

namespace dataset2rawlog {

/** Which frames of a sequence to take: FIRST, FIRST + STEP, ... up to LAST, counted from 0. */
struct FrameRange {
  std::size_t first = 0, step = 1, last = static_cast<std::size_t>(-1);

  bool contains(std::size_t frame) const {
    return frame >= first && frame <= last && (frame - first) % step == 0;
  }
};

/** Parses "FIRST:STEP:LAST"; LAST may be left out ("1:2:" is all odd frames).
 * \throw std::invalid_argument naming the text. */
FrameRange parseFrameRange(const std::string& text);

using label_noise::LabelNoise;

/** What all data sets have in common. */
struct Conversion {
  std::filesystem::path output;
  /** Class table file; empty: the data set's ids are the classes (PCD only). */
  std::filesystem::path classes;
  FrameRange frames;
  /** Share of the labels that is replaced by other classes, how, and with which seed. */
  double labelNoise = 0;
  LabelNoise::Kind labelNoiseKind = LabelNoise::Kind::Points;
  std::uint64_t seed = 1;
  /** Whether scans come with their labels. */
  bool labels = true;
  /** Whether the cameras' images come along (SemanticKITTI only). */
  bool images = false;
  /** Asks to stop early. */
  const StopRequest* stop = nullptr;
};

/** What went into the rawlog. */
struct Summary {
  std::size_t scans = 0, points = 0, labeled = 0;
  /** Frames that had no pose or no labels at their time. */
  std::size_t skipped = 0;
};

/** The rawlog being written: poses and labeled clouds, with the label noise applied. */
class Output {
 public:
  /** The conversion must outlive it. */
  Output(const Conversion& conversion, const semantic_types::ClassTable& table);

  /** Whether a frame is to be converted; says on the way how far that is.
   * \param numFrames of the data set, wanted or not; 0: nobody knows */
  bool wants(std::size_t frame, std::size_t numFrames = 0);

  /** Adds the robot's pose at a time. */
  void writePose(mrpt::Clock::time_point time, const mrpt::poses::CPose3D& T_map_robot);

  /** Adds a cloud, after its labels took the noise. \param times of points, if they have some */
  void writeCloud(mrpt::Clock::time_point time, const std::string& sensorLabel,
                  semantic_types::LabeledCloud cloud,
                  const mrpt::poses::CPose3D& T_robot_sensor = {}, std::vector<float> times = {});

  /** Adds another observation of so many points, whose labels took the noise already. */
  void writeScan(const mrpt::obs::CObservation& observation, std::size_t points,
                 std::size_t labeled);

  /** Adds a depth image with the labels of its pixels, if any: as pixelLabels if these can hold all
   * classes (64), else as a labeled cloud. */
  void writeDepth(mrpt::obs::CObservation3DRangeScan& scan,
                  std::optional<labeled_cloud::LabelImage> labels);

  /** Adds what is no scan, as a picture. */
  void writeOther(const mrpt::obs::CObservation& observation) { m_writer.write(observation); }

  void skip() { ++m_summary.skipped; }
  LabelNoise& noise() { return m_noise; }

  /** Completes the file. \throw std::runtime_error not a single scan was written. */
  Summary finish();

 private:
  const Conversion& m_conversion;
  semantic_types::ClassTable m_table;
  labeled_cloud::RawlogWriter m_writer;
  LabelNoise m_noise;
  Eigen::Isometry3d m_T_map_robot = Eigen::Isometry3d::Identity();  ///< the last pose
  std::vector<std::string> m_classNames;
  Summary m_summary;
  std::optional<Progress> m_progress;
};

/** A time that a line of a file has. \throw std::runtime_error naming the line: none that can be.
 */
mrpt::Clock::time_point timeOf(double seconds, const strict_files::TextLine& line);

/** A frame's number as names of files have it: 000012. */
std::string sixDigits(std::size_t number);

/** The folder of the images of a rawlog: X_Images for X.rawlog. */
std::filesystem::path imagesOf(const std::filesystem::path& rawlog);

/** A sequence in SemanticKITTI's layout: velodyne/, labels/, calib.txt, poses.txt, times.txt. Each
 * scan becomes a CObservationRobotPose (the LiDAR's pose inv(Tr) * P * Tr) and a
 * CObservationLabeledCloud. With `images` a CObservationImage comes between, whose file of image_2/
 * is copied into the folder X_Images beside X.rawlog.
 * \throw std::runtime_error naming file and value of whatever is missing or malformed. */
Summary convertSemanticKitti(const std::filesystem::path& sequence, const Conversion& conversion);

/** A sequence in the layout of TUM RGB-D with label images: depth.txt, label.txt, groundtruth.txt,
 * camera.ini and perhaps rgb.txt. The poses are of the optical frame (x right, y down, z forward).
 * The robot's frame is the camera's with x forward, y left, z up. Without `labels`:
 * CObservation3DRangeScan without labels (label.txt is not read). With them: with pixelLabels if
 * these can hold all classes (64), else a CObservationLabeledCloud.
 * \throw std::runtime_error as above. */
Summary convertTumSequence(const std::filesystem::path& folder, const Conversion& conversion);

/** Point clouds as PCD, see labeled_cloud::readPointFile(), in the world's frame; VIEWPOINT is the
 * sensor's pose. A file a scan, one second apart. \param labelField the field with the labels,
 * unless they are not wanted \throw std::runtime_error as above. */
Summary convertPointFiles(const std::vector<std::filesystem::path>& files,
                          const std::string& labelField, const Conversion& conversion);

/** A log of CARMEN: the scans of laser scanners become CObservation2DRangeScan, where the robot's
 * odometry had it CObservationOdometry. Lines of other kinds are left out. Lines of FLASER and
 * RLASER do not say how far beams are from each other. PARAM laser_front_laser_resolution does, or
 * their number (180 or 181: 1 degree, 360 or 361: 0.5, 400 or 401: 0.25).
 * \throw std::runtime_error naming file and line of whatever is malformed. */
Summary convertCarmen(const std::filesystem::path& log, const Conversion& conversion);

/** What to take of a bag. */
struct BagChoice {
  /** Topics of points: clouds, depth images, laser scans. None: the only topic of the first kind
   * that the bag has. */
  std::vector<std::string> topics;
  std::string labelField = "label";  ///< of clouds: raw ids of the class table; "rgb": its colors
  /** Topic of label images for depth images; empty: the only one with "label" in its name. Or a
   * folder of label images (labeled_cloud::LabelFolder): named by their times, or by the number of
   * the scan, of six digits. */
  std::string labelImages;
};

/** A bag of ROS 2: .mcap, .db3, or a folder of these. Clouds (sensor_msgs/PointCloud2) become
 * CObservationLabeledCloud, depth images (sensor_msgs/Image with the CameraInfo beside them, and
 * label images) CObservation3DRangeScan, laser scans (sensor_msgs/LaserScan)
 * CObservation2DRangeScan, each behind a CObservationRobotPose. The robot is the first frame that
 * moves, from the sensor's upwards. The map's frame is the highest that /tf knows. Where /tf does
 * not tell, odometry (nav_msgs/Odometry) does. Where nothing moves there are no poses.
 * \throw std::runtime_error naming the file, the number of the message and its topic. */
Summary convertRosbag2(const std::filesystem::path& bag, const BagChoice& choice,
                       const Conversion& conversion);

}  // namespace dataset2rawlog
