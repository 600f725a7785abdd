#include <labeled_cloud/Trajectory.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <stdexcept>

#include "Conversion.h"
#include "bags/Bag.h"
#include "bags/BagMessages.h"

namespace dataset2rawlog {
namespace {

namespace fs = std::filesystem;
using bags::BagTopic;
using semantic_types::ClassTable;
using semantic_types::kNoClass;

/** The topics of points that were asked for, or the only one that there is. */
std::vector<std::string> topicsOfPoints(const fs::path& bag,
                                        const std::vector<std::string>& asked) {
  std::vector<std::string> there;
  for (const BagTopic& topic : bags::topicsOfBag(bag))
    if (topic.type == bags::kPointCloud2) there.push_back(topic.name);
  const std::string list = there.empty() ? "none" : strict_files::joined(there);
  for (const std::string& name : asked)
    if (std::find(there.begin(), there.end(), name) == there.end())
      throw std::runtime_error(bag.string() + ": no topic '" + name +
                               "' of points is in this bag; there are: " + list);
  if (!asked.empty()) return asked;
  if (there.size() != 1)
    throw std::runtime_error(bag.string() +
                             ": --topics has to choose the topics of points; there are: " + list);
  return there;
}

bags::BagFrames framesOf(const fs::path& bag) {
  bags::BagFrames frames;
  const auto isOf = [](const char* type) {
    return [type](const BagTopic& topic) { return topic.type == type; };
  };
  bags::readBag(bag, isOf(bags::kTransforms), [&](const BagTopic& topic, std::string_view message) {
    const std::string& name = topic.name;
    const std::string kStatic = "tf_static";
    const bool isStatic = name.size() >= kStatic.size() &&
                          name.compare(name.size() - kStatic.size(), kStatic.size(), kStatic) == 0;
    for (const auto& pose : bags::transformsOfMessage(message)) frames.add(pose, isStatic);
    return true;
  });
  bags::readBag(bag, isOf(bags::kOdometry), [&](const BagTopic&, std::string_view message) {
    frames.addOdometry(bags::odometryOfMessage(message));
    return true;
  });
  return frames;
}

mrpt::poses::CPose3D poseOf(const Eigen::Isometry3d& T) {
  return mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(T.matrix()));
}

/** Writes the scans of a bag. */
class BagScans {
 public:
  BagScans(const fs::path& bag, const std::string& labelField, const Conversion& conversion)
      : m_table(conversion.classes.empty() ? ClassTable()
                                           : semantic_types::loadClassTable(conversion.classes)),
        m_frames(framesOf(bag)),
        m_labelField(conversion.labels ? labelField : ""),
        m_output(conversion, m_table) {}

  void add(std::size_t frame, const BagTopic& topic, std::string_view message) {
    if (!m_output.wants(frame)) return;
    const bags::BagCloud cloud = bags::cloudOfMessage(message);
    labeled_cloud::CObservationLabeledCloud scan;
    scan.timestamp = labeled_cloud::timeOfSeconds(static_cast<double>(cloud.stamp) * 1e-9);
    scan.sensorLabel = topic.name;
    if (!place(cloud, scan)) return m_output.skip();
    std::string problem;
    scan.cloud = point_fields::cloudOf(cloud.points, m_labelField, m_table, problem);
    if (!m_labelField.empty() && !problem.empty()) throw std::runtime_error(problem);
    if (m_labelField.empty()) scan.cloud.classes.clear();
    for (int id = 1; id <= m_table.size(); ++id)
      scan.classNames.push_back(m_table.name(static_cast<semantic_types::ClassId>(id)));
    const auto& classes = scan.cloud.classes;
    const auto unlabeled = std::count(classes.begin(), classes.end(), kNoClass);
    m_output.writeScan(scan, scan.cloud.size(),
                       classes.size() - static_cast<std::size_t>(unlabeled));
  }
  Summary finish() { return m_output.finish(); }

 private:
  /** Writes where the robot is, if anything moves. \return whether that is known */
  bool place(const bags::BagCloud& cloud, labeled_cloud::CObservationLabeledCloud& scan) {
    const std::string robot = m_frames.robotOf(cloud.frame);
    if (robot.empty()) return true;
    const auto T_map_robot = m_frames.find(robot, cloud.stamp);
    if (!T_map_robot) return false;
    m_output.writePose(scan.timestamp, poseOf(*T_map_robot));
    scan.sensorPose = poseOf(m_frames.find(cloud.frame, cloud.stamp, robot).value());
    return true;
  }

  ClassTable m_table;
  bags::BagFrames m_frames;
  std::string m_labelField;
  Output m_output;
};

}  // namespace

Summary convertRosbag2(const fs::path& bag, const std::vector<std::string>& topics,
                       const std::string& labelField, const Conversion& conversion) {
  const std::vector<std::string> wanted = topicsOfPoints(bag, topics);
  BagScans scans(bag, labelField, conversion);
  std::size_t frame = 0;
  const auto isWanted = [&](const BagTopic& topic) {
    return topic.type == bags::kPointCloud2 &&
           std::find(wanted.begin(), wanted.end(), topic.name) != wanted.end();
  };
  bags::readBag(bag, isWanted, [&](const BagTopic& topic, std::string_view message) {
    try {
      scans.add(frame, topic, message);
    } catch (const std::exception& e) {
      throw std::runtime_error("message " + std::to_string(frame) + " of " + topic.name + ": " +
                               e.what());
    }
    ++frame;
    return !(conversion.stop && conversion.stop->pending());
  });
  return scans.finish();
}

}  // namespace dataset2rawlog
