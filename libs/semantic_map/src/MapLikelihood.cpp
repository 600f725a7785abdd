#include <labeled_cloud/ScanConverter.h>
#include <semantic_map/CSemanticOctoMap.h>

#include <cmath>

#include "PointLikelihood.h"
#include "SensorPose.h"

namespace semantic_map {

using labeled_cloud::ScanConverter;
using semantic_octree::LabeledCloud;

namespace {

double logLikelihood(const PointLikelihood& likelihood, const LabeledCloud& cloud, std::size_t i,
                     const Eigen::Vector3d& point, bool useLabels) {
  if (useLabels && !cloud.probabilities.empty())
    return std::log(
        likelihood(point, &cloud.probabilities[i * cloud.probabilities.size() / cloud.size()]));
  if (useLabels && !cloud.classes.empty()) return std::log(likelihood(point, cloud.classes[i]));
  return std::log(likelihood(point));
}

}  // namespace

bool CSemanticOctoMap::internal_canComputeObservationLikelihood(
    const mrpt::obs::CObservation& observation) const {
  return ScanConverter::accepts(observation);
}

double CSemanticOctoMap::internal_computeObservationLikelihood(
    const mrpt::obs::CObservation& observation, const mrpt::poses::CPose3D& T_map_robot) const {
  if (!ScanConverter::accepts(observation)) return 0;
  const auto scan = *converter().convert(observation);
  const auto T_map_sensor = sensorPose(T_map_robot, scan.T_robot_sensor);
  const PointLikelihood likelihood(m_tree);
  double sum = 0;
  for (std::size_t i = 0; i < scan.cloud.size(); i += likelihoodOptions.decimation)
    sum +=
        logLikelihood(likelihood, scan.cloud, i, T_map_sensor * scan.cloud.points[i].cast<double>(),
                      likelihoodOptions.useLabels);
  return likelihoodOptions.pointWeight * sum;
}

}  // namespace semantic_map
