#pragma once
#include <semantic_types/ClassTable.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "FrameRange.h"
#include "Signals.h"
#include "label_noise/LabelNoise.h"

namespace dataset2rawlog {

using label_noise::LabelNoise;

/** What all data sets have in common. */
struct Conversion {
  std::filesystem::path output;
  /** Class table file; empty: the data set's ids are the classes (PCD and PLY only). */
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

/** A sequence in SemanticKITTI's layout: velodyne/, labels/, calib.txt, poses.txt, times.txt.
 * Each scan becomes a CObservationRobotPose (the LiDAR's pose inv(Tr) * P * Tr), with
 * `images` a CObservationImage, whose file of image_2/ is copied into the folder X_Images beside
 * X.rawlog, and a CObservationLabeledCloud.
 * \throw std::runtime_error naming file and value of whatever is missing or malformed. */
Summary convertSemanticKitti(const std::filesystem::path& sequence, const Conversion& conversion);

/** A sequence in the layout of TUM RGB-D with label images: depth.txt, label.txt, groundtruth.txt,
 * camera.ini and perhaps rgb.txt. The poses are those of the optical frame (x right, y down, z
 * forward); the robot's frame is the camera's with x forward, y left, z up.
 * Without `labels`: CObservation3DRangeScan without labels (label.txt is not read).
 * With them: with pixelLabels if these can hold all classes (64), else a CObservationLabeledCloud.
 * \throw std::runtime_error as above. */
Summary convertTumSequence(const std::filesystem::path& folder, const Conversion& conversion);

/** Point clouds as PCD or PLY, see labeled_cloud::readPointFile(), in the world's frame; VIEWPOINT
 * of a PCD is the sensor's pose, that of a PLY the origin. A file a scan, one second apart. \param
 * labelField the field with the labels, unless they are not wanted \throw std::runtime_error as
 * above. */
Summary convertPointFiles(const std::vector<std::filesystem::path>& files,
                          const std::string& labelField, const Conversion& conversion);

/** A log of CARMEN: the scans of laser scanners become CObservation2DRangeScan, where the robot's
 * odometry had it CObservationOdometry. Lines of other kinds are left out. Lines of FLASER and
 * RLASER do not say how far beams are from each other: that follows from their number (180 or 181:
 * 1 degree, 360 or 361: 0.5, 400 or 401: 0.25), or from PARAM laser_front_laser_resolution.
 * \throw std::runtime_error naming file and line of whatever is malformed. */
Summary convertCarmen(const std::filesystem::path& log, const Conversion& conversion);

/** A bag of ROS 2: .mcap, .db3, or a folder of these. Clouds (sensor_msgs/PointCloud2) become
 * CObservationLabeledCloud, each behind a CObservationRobotPose. The robot is the frame that moves,
 * from the cloud's upwards; the map's frame is the highest that /tf knows, or that of odometry
 * (nav_msgs/Odometry) where /tf does not tell. Where nothing moves there are no poses.
 * \param topics of clouds; none: the only one that the bag has \param labelField the points' field
 * with raw ids of the class table, or "rgb" \throw std::runtime_error naming the file, the number
 * of the message and its topic. */
Summary convertRosbag2(const std::filesystem::path& bag, const std::vector<std::string>& topics,
                       const std::string& labelField, const Conversion& conversion);

}  // namespace dataset2rawlog
