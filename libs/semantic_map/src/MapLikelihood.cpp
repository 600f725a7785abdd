#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_map/PointLikelihood.h>

#include <cmath>

#include "LikelihoodCache.h"
#include "SensorPose.h"

namespace semantic_map {

using labeled_cloud::LabeledScan;
using semantic_octree::SemanticOcTree;
using semantic_types::LabeledCloud;

namespace {

/** The log-likelihood of single points of a scan at a pose. */
class BeamLikelihood {
 public:
  BeamLikelihood(const SemanticOcTree& tree, const LabeledCloud& cloud,
                 const Eigen::Isometry3d& T_map_sensor, const TLikelihoodOptions& options,
                 const semantic_octree::InsertionOptions& ranges)
      : m_point(tree),
        m_cloud(cloud),
        m_T_map_sensor(T_map_sensor),
        m_useLabels(options.useLabels),
        m_step(options.beamStep),
        m_margin(std::max(tree.getResolution(), ranges.carvingMargin)),
        m_minRange(ranges.minRange),
        m_maxRange(ranges.maxRange) {}

  double operator()(std::size_t i) const {
    const Eigen::Vector3d point = m_cloud.points[i].cast<double>();
    const double range = point.norm();
    if (!std::isfinite(range) || range < m_minRange) return 0;
    const bool ends = m_maxRange == 0 || range <= m_maxRange;
    const double passing =
        m_step == 0 ? 1 : way(point / range, ends ? range - m_margin : m_maxRange);
    return std::log(passing) + (ends ? std::log(end(i, m_T_map_sensor * point)) : 0);
  }

 private:
  /** Of passing all places before a length, m. */
  double way(const Eigen::Vector3d& direction, double length) const {
    double product = 1;
    for (double along = m_step / 2; along < length; along += m_step)
      product *= m_point.passing(m_T_map_sensor * (along * direction));
    return product;
  }

  double end(std::size_t i, const Eigen::Vector3d& point) const {
    if (m_useLabels && !m_cloud.probabilities.empty())
      return m_point(point,
                     &m_cloud.probabilities[i * m_cloud.probabilities.size() / m_cloud.size()]);
    if (m_useLabels && !m_cloud.classes.empty()) return m_point(point, m_cloud.classes[i]);
    return m_point(point);
  }

  PointLikelihood m_point;
  const LabeledCloud& m_cloud;
  Eigen::Isometry3d m_T_map_sensor;
  bool m_useLabels;
  double m_step, m_margin, m_minRange, m_maxRange;
};

}  // namespace

std::shared_ptr<const LabeledScan> CSemanticOctoMap::scanForLikelihood(
    const mrpt::obs::CObservation& observation) const {
  return m_likelihoodCache->scanOf(observation, {m_tree.classes(), insertionOptions.conversion},
                                   m_logger);
}

bool CSemanticOctoMap::internal_canComputeObservationLikelihood(
    const mrpt::obs::CObservation& observation) const {
  return scanForLikelihood(observation) != nullptr;
}

double CSemanticOctoMap::internal_computeObservationLikelihood(
    const mrpt::obs::CObservation& observation, const mrpt::poses::CPose3D& T_map_robot) const {
  const auto scan = scanForLikelihood(observation);
  if (!scan) return 0;
  const auto T_map_sensor = sensorPose(T_map_robot, scan->T_robot_sensor);
  const auto lock = reading();
  const BeamLikelihood likelihood(m_tree, scan->cloud, T_map_sensor, likelihoodOptions,
                                  insertionOptions.scan);
  double sum = 0;
  for (std::size_t i = 0; i < scan->cloud.size(); i += likelihoodOptions.decimation)
    sum += likelihood(i);
  return likelihoodOptions.pointWeight * sum;
}

}  // namespace semantic_map
