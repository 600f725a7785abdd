#include <labeled_cloud/Trajectory.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <iterator>
#include <map>
#include <regex>
#include <stdexcept>
#include <utility>

#include "Conversion.h"
#include "bags/Bag.h"
#include "bags/BagMessages.h"

namespace dataset2rawlog {
namespace {

namespace fs = std::filesystem;
using bags::BagTopic;
using labeled_cloud::toMrpt;
using point_fields::Frames;
using semantic_types::ClassTable;
using Names = std::vector<std::string>;

bool isIn(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/** What a bag has, by a look at all of it. */
class BagContents {
 public:
  explicit BagContents(const fs::path& bag) : m_bag(bag) {
    const auto isOfUse = [this](const BagTopic& topic) { return note(topic); };
    bags::readBag(bag, isOfUse, [this](const BagTopic& topic, std::string_view message) {
      try {
        look(topic, message);
      } catch (const std::exception& e) {
        throw std::runtime_error("a message of " + topic.name + ": " + e.what());
      }
      return true;
    });
    for (const auto& pose : m_odometry) frames.add(pose, Frames::Kind::Odometers);
    for (const auto& [name, encoding] : m_encodings)
      if (point_fields::mayBeDepth(encoding) && name.find("label") == std::string::npos)
        depths.push_back(name);
  }

  /** The topics that were asked for, or the only one of the first kind that there is. */
  Names topicsOfPoints(const Names& asked) const {
    Names there;
    for (const Names* kind : {&clouds, &depths, &lasers})
      there.insert(there.end(), kind->begin(), kind->end());
    const std::string list = there.empty() ? "none" : strict_files::joined(there);
    for (const std::string& name : asked)
      if (!isIn(there, name))
        throw std::runtime_error(m_bag.string() + ": no topic '" + name +
                                 "' of points is in this bag; there are: " + list);
    if (!asked.empty()) return asked;
    const Names& first = !clouds.empty() ? clouds : !depths.empty() ? depths : lasers;
    if (first.size() == 1) return first;
    throw std::runtime_error(m_bag.string() +
                             ": --topics has to choose the topics of points; there are: " + list);
  }
  /** The topic of label images that was asked for, or the only one that has "label" in its name;
   * none: empty. */
  std::string topicOfLabels(const std::string& asked) const {
    Names found;
    for (const auto& [name, encoding] : m_encodings)
      if (asked.empty() ? name.find("label") != std::string::npos : name == asked)
        found.push_back(name);
    if (found.size() > 1)
      throw std::runtime_error(m_bag.string() + ": --label-images has to choose one of " +
                               strict_files::joined(found));
    if (!asked.empty() && found.empty())
      throw std::runtime_error(m_bag.string() + ": no topic '" + asked +
                               "' of images is in this bag");
    return found.empty() ? "" : found[0];
  }
  /** The calibration beside an image, or the only one. */
  const point_fields::RawCamera& cameraOf(const std::string& image) const {
    const auto beside = m_cameras.find(image.substr(0, image.rfind('/')) + "/camera_info");
    if (beside != m_cameras.end()) return beside->second;
    if (m_cameras.size() == 1) return m_cameras.begin()->second;
    throw std::runtime_error("there is no " + image.substr(0, image.rfind('/')) + "/camera_info");
  }

  Names clouds, depths, lasers;
  Frames frames{false};

 private:
  bool note(const BagTopic& topic) {
    Names* const kind = topic.type == bags::kPointCloud2 ? &clouds
                        : topic.type == bags::kLaserScan ? &lasers
                                                         : nullptr;
    if (kind && !isIn(*kind, topic.name))
      kind->insert(std::upper_bound(kind->begin(), kind->end(), topic.name), topic.name);
    return topic.type == bags::kTransforms || topic.type == bags::kOdometry ||
           topic.type == bags::kImage || topic.type == bags::kCameraInfo;
  }
  void look(const BagTopic& topic, std::string_view message) {
    if (topic.type == bags::kTransforms)
      for (const auto& pose : bags::transformsOfMessage(message))
        frames.add(pose,
                   endsWith(topic.name, "tf_static") ? Frames::Kind::Static : Frames::Kind::Moving);
    else if (topic.type == bags::kOdometry)
      m_odometry.push_back(bags::odometryOfMessage(message));
    else if (topic.type == bags::kCameraInfo && m_cameras.count(topic.name) == 0)
      m_cameras[topic.name] = bags::cameraOfMessage(message);
    else if (topic.type == bags::kImage && m_encodings.count(topic.name) == 0)
      m_encodings[topic.name] = bags::imageOfMessage(message).pixels.encoding;
  }

  fs::path m_bag;
  std::vector<bags::FramePose> m_odometry;
  std::map<std::string, point_fields::RawCamera> m_cameras;
  std::map<std::string, std::string> m_encodings;  ///< of images' topics
};

/** MRPT's scan of ROS's: its beams lie evenly around the frame's x axis, which ROS's do not. */
mrpt::obs::CObservation2DRangeScan laserScanOf(const point_fields::RawLaserScan& beams) {
  mrpt::obs::CObservation2DRangeScan scan;
  scan.aperture = std::abs(beams.angleStep) * static_cast<float>(beams.ranges.size() - 1);
  scan.rightToLeft = beams.angleStep >= 0;
  scan.maxRange = beams.mostRange;
  scan.resizeScan(beams.ranges.size());
  for (std::size_t i = 0; i < beams.ranges.size(); ++i) {
    const float range = beams.ranges[i];
    const bool isValid = range >= beams.leastRange && range <= beams.mostRange;
    scan.setScanRange(i, isValid ? range : range == INFINITY ? beams.mostRange : 0);
    scan.setScanRangeValidity(i, isValid && std::isfinite(range));
  }
  return scan;
}

/** Label images by the number of the scan, if one is named so; else by their time. */
labeled_cloud::LabelFolder folderOf(const fs::path& folder, const ClassTable& table) {
  labeled_cloud::LabelFolderOptions options;
  for (const auto& file : fs::directory_iterator(folder))
    if (std::regex_match(file.path().stem().string(), std::regex("\\d{6}")))
      options.match = labeled_cloud::LabelFolderOptions::Match::Name;
  return {folder, table, options};
}

/** Writes the scans of a bag. */
class BagScans {
 public:
  /** \param labelTopic of label images; empty: they are in a folder, or there are none */
  BagScans(const BagContents& contents, const BagChoice& choice, std::string labelTopic,
           const Conversion& conversion)
      : m_contents(contents),
        m_table(conversion.classes.empty() ? ClassTable()
                                           : semantic_types::loadClassTable(conversion.classes)),
        m_labelField(conversion.labels ? choice.labelField : ""),
        m_labelTopic(std::move(labelTopic)),
        m_output(conversion, m_table) {
    if (conversion.labels && fs::is_directory(choice.labelImages))
      m_labelFolder = folderOf(choice.labelImages, m_table);
  }

  /** Label images are those of the depth images with their stamp, which wait for them. */
  void add(const BagTopic& topic, std::string_view message) {
    constexpr std::size_t kMostWaiting = 100;
    if (topic.name == m_labelTopic) {
      m_labels[bags::headerOfMessage(message).stamp] = message;
      if (m_labels.size() > kMostWaiting) m_labels.erase(m_labels.begin());
    } else {
      m_waiting.push_back({m_number++, topic, std::string(message)});
    }
    while (!m_waiting.empty() && (m_waiting.size() > kMostWaiting || isComplete(m_waiting.front())))
      writeFirst();
  }
  Summary finish() {
    while (!m_waiting.empty()) writeFirst();
    return m_output.finish();
  }

 private:
  struct Waiting {
    std::size_t number;
    BagTopic topic;
    std::string message;
  };
  bool takesLabels(const Waiting& scan) const {
    return scan.topic.type == bags::kImage && !m_labelTopic.empty();
  }
  bool isComplete(const Waiting& scan) const try {
    return !takesLabels(scan) || m_labels.count(bags::headerOfMessage(scan.message).stamp) > 0;
  } catch (const std::exception&) {
    return true;  // it is refused
  }

  void writeFirst() {
    const Waiting scan = std::move(m_waiting.front());
    m_waiting.pop_front();
    if (!m_output.wants(scan.number)) return;
    try {
      if (scan.topic.type == bags::kPointCloud2) writeCloud(scan);
      if (scan.topic.type == bags::kLaserScan) writeLaserScan(scan);
      if (scan.topic.type == bags::kImage) writeDepth(scan);
    } catch (const std::exception& e) {
      throw std::runtime_error("message " + std::to_string(scan.number) + " of " + scan.topic.name +
                               ": " + e.what());
    }
  }

  void writeCloud(const Waiting& waiting) {
    const bags::BagCloud message = bags::cloudOfMessage(waiting.message);
    const auto T_robot_sensor = place(message);
    if (!T_robot_sensor) return m_output.skip();
    std::string problem;
    auto cloud = point_fields::cloudOf(message.points, m_labelField, m_table, problem);
    if (!m_labelField.empty() && !problem.empty()) throw std::runtime_error(problem);
    if (m_labelField.empty()) cloud.classes.clear();
    m_output.writeCloud(timeOf(message), waiting.topic.name, std::move(cloud),
                        toMrpt(*T_robot_sensor),
                        timesOf(message.points, static_cast<double>(message.stamp) * 1e-9));
  }

  /** MRPT's laser scans have no times of beams: a cloud has them. */
  void writeLaserScan(const Waiting& waiting) {
    const bags::BagLaserScan message = bags::laserScanOfMessage(waiting.message);
    const auto& beams = message.beams;
    const auto steps = static_cast<double>(beams.ranges.size()) - 1;
    const double middle = double(beams.firstAngle) + double(beams.angleStep) * steps / 2;
    if (beams.ranges.empty() || !std::isfinite(middle))
      throw std::runtime_error("a laser scan without beams, or with angles that are no numbers");
    const auto T_robot_sensor = place(message);
    if (!T_robot_sensor) return m_output.skip();
    std::vector<float> times;
    auto cloud = cloudOf(beams, times);
    if (!times.empty())
      return m_output.writeCloud(timeOf(message), waiting.topic.name, std::move(cloud),
                                 toMrpt(*T_robot_sensor), std::move(times));
    auto scan = laserScanOf(beams);
    scan.timestamp = timeOf(message);
    scan.sensorLabel = waiting.topic.name;
    scan.sensorPose = toMrpt(*T_robot_sensor) + mrpt::poses::CPose3D(0, 0, 0, middle, 0, 0);
    m_output.writeScan(scan, scan.getScanSize(), 0);
  }

  void writeDepth(const Waiting& waiting) {
    const bags::BagImage message = bags::imageOfMessage(waiting.message);
    auto scan = point_fields::depthOf(message.pixels, m_contents.cameraOf(waiting.topic.name));
    auto classes = classesFor(waiting, message);
    if (!classes && (m_labelFolder || takesLabels(waiting))) return m_output.skip();
    const auto T_robot_optical = place(message);
    if (!T_robot_optical) return m_output.skip();
    scan.timestamp = timeOf(message);
    scan.sensorLabel = waiting.topic.name;
    scan.sensorPose = toMrpt(*T_robot_optical * point_fields::T_optical_camera());
    m_output.writeDepth(scan, std::move(classes));
  }

  /** The classes of a depth image's pixels, from the folder or the topic. */
  std::optional<labeled_cloud::LabelImage> classesFor(const Waiting& depth,
                                                      const bags::BagHeader& seen) {
    if (m_labelFolder) {
      mrpt::obs::CObservationImage named;
      named.timestamp = timeOf(seen);
      named.image.setExternalStorage(sixDigits(depth.number));
      return m_labelFolder->label(named);
    }
    const auto labels = m_labels.find(seen.stamp);
    if (!takesLabels(depth) || labels == m_labels.end()) return std::nullopt;
    std::string problem;
    auto classes =
        point_fields::labelsOf(bags::imageOfMessage(labels->second).pixels, m_table, problem);
    if (!problem.empty()) throw std::runtime_error(m_labelTopic + ": " + problem);
    m_labels.erase(m_labels.begin(), std::next(labels));
    return classes;
  }

  static mrpt::Clock::time_point timeOf(const bags::BagHeader& header) {
    return labeled_cloud::timeOfSeconds(static_cast<double>(header.stamp) * 1e-9);
  }

  /** Writes where the robot is, if anything moves.
   * \return T_robot_sensor; none: where the robot is, or its sensor on it, is not known */
  std::optional<Eigen::Isometry3d> place(const bags::BagHeader& seen) {
    const Frames& frames = m_contents.frames;
    const std::string robot = frames.robotOf(seen.frame), map = frames.rootOf(seen.frame);
    if (robot.empty()) return Eigen::Isometry3d::Identity();
    const auto T_map_robot = frames.find(map, robot, seen.stamp).T_target_source;
    const auto T_robot_sensor = frames.find(robot, seen.frame, seen.stamp).T_target_source;
    if (T_map_robot && T_robot_sensor) m_output.writePose(timeOf(seen), toMrpt(*T_map_robot));
    return T_map_robot ? T_robot_sensor : std::nullopt;
  }

  const BagContents& m_contents;
  ClassTable m_table;
  std::string m_labelField, m_labelTopic;
  std::optional<labeled_cloud::LabelFolder> m_labelFolder;
  std::map<bags::Stamp, std::string> m_labels;  ///< messages
  std::deque<Waiting> m_waiting;
  std::size_t m_number = 0;
  Output m_output;
};

}  // namespace

Summary convertRosbag2(const fs::path& bag, const BagChoice& choice, const Conversion& conversion) {
  const BagContents contents(bag);
  const Names wanted = contents.topicsOfPoints(choice.topics);
  const bool hasDepth = std::any_of(wanted.begin(), wanted.end(), [&](const std::string& name) {
    return isIn(contents.depths, name);
  });
  const std::string labels = conversion.labels && hasDepth && !fs::is_directory(choice.labelImages)
                                 ? contents.topicOfLabels(choice.labelImages)
                                 : "";
  BagScans scans(contents, choice, labels, conversion);
  const auto isWanted = [&](const BagTopic& topic) {
    return (topic.name == labels && topic.type == bags::kImage) || isIn(wanted, topic.name);
  };
  bags::readBag(bag, isWanted, [&](const BagTopic& topic, std::string_view message) {
    scans.add(topic, message);
    return !(conversion.stop && conversion.stop->pending());
  });
  return scans.finish();
}

}  // namespace dataset2rawlog
