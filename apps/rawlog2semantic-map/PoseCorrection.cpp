#include "PoseCorrection.h"

#include <iomanip>
#include <sstream>

namespace rawlog2semantic_map {
namespace {

/** Keyframes are moved on the way if they are off by more voxels. */
constexpr double kOff = 0.25;

Eigen::Isometry3d isometry(const mrpt::poses::CPose3D& pose) {
  return Eigen::Isometry3d(pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen());
}

}  // namespace

PoseCorrection::PoseCorrection(semantic_octree::SemanticOcTree& map,
                               const semantic_slam::SlamOptions& options,
                               const std::filesystem::path& folder)
    : m_slam(options), m_keyframes(map, folder) {}

semantic_octree::InsertionReport PoseCorrection::insert(
    const labeled_cloud::LabeledScan& scan, const mrpt::poses::CPose3D& T_map_robot,
    const semantic_octree::InsertionOptions& options, double secondsSince) {
  const Eigen::Isometry3d T_robot_sensor = isometry(scan.T_robot_sensor);
  const auto added = m_slam.add(scan.cloud, T_robot_sensor, isometry(T_map_robot));
  if (added.isNew) {
    m_keyframes.begin(m_slam.poses().back());
    m_times.push_back(mrpt::Clock::toDouble(scan.timestamp));
  }
  const auto report = m_keyframes.insert(scan.cloud, added.T_keyframe_robot * T_robot_sensor,
                                         options, secondsSince);
  if (added.posesMoved)
    m_keyframes.move(posesOff(m_slam, m_keyframes, kOff * m_keyframes.map().getResolution()));
  return report;
}

SlamSummary PoseCorrection::summary() const {
  return {m_slam.poses().size(), m_slam.numLoops(), m_slam.numReferenced(), m_slam.numLost()};
}

std::string PoseCorrection::trajectory() const {
  std::ostringstream out;
  for (std::size_t k = 0; k < m_times.size(); ++k) {
    const Eigen::Isometry3d& T = m_slam.poses()[k];
    const Eigen::Quaterniond q(T.linear());
    out << std::fixed << std::setprecision(6) << m_times[k] << std::setprecision(9);
    for (const double x : {T.translation().x(), T.translation().y(), T.translation().z(), q.x(),
                           q.y(), q.z(), q.w()})
      out << ' ' << x;
    out << '\n';
  }
  return out.str();
}

}  // namespace rawlog2semantic_map
