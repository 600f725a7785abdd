#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_octree/SemanticOcTree.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "LikelihoodCache.h"

namespace semantic_map {

using labeled_cloud::LabeledScan;
using semantic_octree::SemanticOcTree;
using semantic_types::ClassId;
using semantic_types::kNoClass;
using semantic_types::LabeledCloud;

namespace {

/** Likelihood that a return ends at a place of the map, or that a beam passes through it. It
 * follows the sensor model of the map's filter; TLikelihoodOptions has the equations. */
class PointLikelihood {
 public:
  explicit PointLikelihood(const SemanticOcTree& tree)
      : m_tree(tree),
        m_hit(tree.filterParameters().hitProbability),
        m_falseAlarm(tree.filterParameters().falseAlarmProbability),
        m_accuracy(tree.numClasses() == 1 ? 1 : tree.filterParameters().accuracy) {}

  /** \param point map frame, m */
  double operator()(const Eigen::Vector3d& point) const { return unlabeled(find(point)); }
  double operator()(const Eigen::Vector3d& point, ClassId label) const {
    const auto node = find(point);
    return label == kNoClass ? unlabeled(node) : labeled(node, label);
  }
  /** \param label K probabilities; all zero: no label */
  double operator()(const Eigen::Vector3d& point, const float* label) const {
    const auto node = find(point);
    double sum = 0, total = 0;
    for (int k = 1; k <= m_tree.numClasses(); ++k) {
      if (label[k - 1] <= 0) continue;
      total += label[k - 1];
      sum += label[k - 1] * labeled(node, static_cast<ClassId>(k));
    }
    return total > 0 ? sum / total : unlabeled(node);
  }
  /** Likelihood that the beam passes. */
  double passing(const Eigen::Vector3d& point) const { return 1 - (*this)(point); }

 private:
  SemanticOcTree::Node find(const Eigen::Vector3d& point) const {
    octomap::OcTreeKey key;
    if (!m_tree.coordToKeyChecked(point.x(), point.y(), point.z(), key)) return {};
    return m_tree.search(key);
  }
  double unlabeled(const SemanticOcTree::Node& node) const {
    return m_falseAlarm + (node ? node.getOccupancy() : 0.5) * (m_hit - m_falseAlarm);
  }
  double labeled(const SemanticOcTree::Node& node, ClassId id) const {
    const int K = m_tree.numClasses();
    double free = 0.5, ofClass = 0.5 / K;
    if (node) {
      const auto belief = m_tree.belief(node);
      const auto p = belief.probabilities(K);
      const int named = belief.indexOf(id);
      free = p.free, ofClass = named < 0 ? p.rest : p.named[named];
    }
    const double wrong = K == 1 ? 0 : (1 - m_accuracy) / (K - 1);
    return free * m_falseAlarm + m_hit * K * (m_accuracy * ofClass + wrong * (1 - free - ofClass));
  }

  const SemanticOcTree& m_tree;
  double m_hit, m_falseAlarm, m_accuracy;
};

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
  /** The likelihood that a beam passes all places before a length, m. */
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

/** Two observations with the same have the same points. Reading each byte once takes a small part
 * of the time that it takes to make points of them. */
std::string bytesOf(const mrpt::obs::CObservation& observation) {
  mrpt::io::CMemoryStream bytes;
  mrpt::serialization::archiveFrom(bytes) << observation;
  return {static_cast<const char*>(bytes.getRawBufferData()), bytes.getTotalBytesCount()};
}

}  // namespace

/** Null if it cannot be used. The reason goes to the logger as a warning, unless it is the same as
 * the last. */
std::shared_ptr<const LabeledScan> CSemanticOctoMap::scanForLikelihood(
    const mrpt::obs::CObservation& observation) const {
  if (!labeled_cloud::ScanConverter::accepts(observation)) return nullptr;
  LikelihoodCache& cache = *m_likelihoodCache;
  const std::lock_guard lock(cache.mutex);
  const std::string refusalBefore = std::exchange(cache.refusal, {});
  const auto& options = insertionOptions.conversion;
  if (!cache.converter || !cache.converter->isFor(m_tree.classes(), options)) {
    cache.converter = std::make_unique<CachedConverter>(m_tree.classes(), options);
    cache.source.clear();
  }
  try {
    std::string source = bytesOf(observation);
    if (source == cache.source) return cache.scan;
    auto scan = cache.converter->converter.convert(observation);
    if (scan->cloud.empty()) throw std::invalid_argument("no point with a usable range");
    cache.scan = std::make_shared<LabeledScan>(std::move(*scan));
    cache.source = std::move(source);
  } catch (const std::exception& e) {
    cache.scan.reset();
    cache.source.clear();
    cache.refusal = e.what();
    if (cache.refusal != refusalBefore)
      m_logger.logStr(mrpt::system::LVL_WARN, "No likelihood: " + cache.refusal);
  }
  return cache.scan;
}

void CSemanticOctoMap::auxParticleFilterCleanUp() {
  const std::lock_guard lock(m_likelihoodCache->mutex);
  m_likelihoodCache->source.clear();
  m_likelihoodCache->scan.reset();
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
