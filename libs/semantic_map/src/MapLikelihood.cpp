#include <labeled_cloud/CObservationLabeledCloud.h>
#include <mrpt/io/CStream.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/serialization/CArchive.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_octree/SemanticOcTree.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

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

}  // namespace

std::shared_ptr<const LabeledScan> CSemanticOctoMap::scanForLikelihood(
    const mrpt::obs::CObservation& observation) const {
  return m_likelihoodCache->scanOf(observation, m_tree.classes(), insertionOptions.conversion,
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

using labeled_cloud::CObservationLabeledCloud;
using mrpt::obs::CObservation;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::TPixelLabelInfo;
using mrpt::obs::TPixelLabelInfoBase;

namespace {

/** Takes bytes and makes a number of them. */
class HashStream : public mrpt::io::CStream {
 public:
  size_t Write(const void* buffer, size_t count) override {
    const std::string_view bytes(static_cast<const char*>(buffer), count);
    m_value = (m_value ^ std::hash<std::string_view>()(bytes)) * 0x9E3779B97F4A7C15u;
    return count;
  }
  template <class T>
  void addAll(const T& values) {
    if (values.size() > 0) Write(values.data(), values.size() * sizeof(values.data()[0]));
  }
  std::uint64_t value() const { return m_value; }

  size_t Read(void*, size_t) override { return 0; }
  std::uint64_t Seek(int64_t, TSeekOrigin) override { return 0; }
  std::uint64_t getTotalBytesCount() const override { return 0; }
  std::uint64_t getPosition() const override { return 0; }

 private:
  std::uint64_t m_value = 1;
};

template <unsigned BYTES>
void addIf(const TPixelLabelInfoBase& labels, HashStream& hash) {
  if (const auto* fields = dynamic_cast<const TPixelLabelInfo<BYTES>*>(&labels))
    hash.addAll(fields->pixelLabels);
}

void addLabels(const TPixelLabelInfoBase& labels, HashStream& hash) {
  addIf<1>(labels, hash), addIf<2>(labels, hash), addIf<3>(labels, hash);
  addIf<4>(labels, hash), addIf<8>(labels, hash);
}

void addRangeScan(const CObservation3DRangeScan& scan, HashStream& hash) {
  auto archive = mrpt::serialization::archiveFrom(hash);
  archive << scan.sensorPose << scan.sensorLabel << scan.cameraParams << scan.rangeUnits
          << scan.hasRangeImage << scan.hasPoints3D << scan.range_is_depth
          << scan.rangeImage_getExternalStorageFile("") << scan.points3D_getExternalStorageFile();
  hash.addAll(scan.rangeImage);
  for (const auto* coordinates : {&scan.points3D_x, &scan.points3D_y, &scan.points3D_z})
    hash.addAll(*coordinates);
  if (!scan.pixelLabels) return;
  for (const auto& [id, name] : scan.pixelLabels->pixelLabelNames) archive << id << name;
  addLabels(*scan.pixelLabels, hash);
}

void addLabeledCloud(const CObservationLabeledCloud& observation, HashStream& hash) {
  auto archive = mrpt::serialization::archiveFrom(hash);
  archive << observation.sensorPose << observation.sensorLabel;
  for (const std::string& name : observation.classNames) archive << name;
  hash.addAll(observation.cloud.points);
  hash.addAll(observation.cloud.classes);
  hash.addAll(observation.cloud.probabilities);
}

/** A number that stands for all that a scan is made of, its labels and the sensor's pose included.
 * Two observations with one number have the same points. Reads each byte once, which takes a small
 * part of the time that it takes to make points of them. */
std::uint64_t fingerprintOf(const CObservation& observation) {
  HashStream hash;
  if (const auto* scan = dynamic_cast<const CObservation3DRangeScan*>(&observation))
    addRangeScan(*scan, hash);
  else if (const auto* cloud = dynamic_cast<const CObservationLabeledCloud*>(&observation))
    addLabeledCloud(*cloud, hash);
  else
    mrpt::serialization::archiveFrom(hash) << observation;
  return hash.value();
}

}  // namespace

std::shared_ptr<const LabeledScan> LikelihoodCache::scanOf(
    const CObservation& observation, const semantic_types::ClassTable& classes,
    const labeled_cloud::ScanConverterOptions& options, mrpt::system::COutputLogger& logger) {
  if (!labeled_cloud::ScanConverter::accepts(observation)) return nullptr;
  const std::uint64_t fingerprint = fingerprintOf(observation);
  const std::lock_guard lock(m_mutex);
  const bool ready = m_converter && m_converter->isFor(classes, options);
  if (ready && fingerprint == m_fingerprint) return m_scan;
  if (!ready) m_converter = std::make_unique<CachedConverter>(classes, options);
  convert(observation, logger);
  m_fingerprint = fingerprint;
  return m_scan;
}

void LikelihoodCache::convert(const CObservation& observation,
                              mrpt::system::COutputLogger& logger) {
  const std::string refusalBefore = m_refusal;
  m_refusal.clear();
  try {
    const auto scan = std::make_shared<LabeledScan>(*m_converter->converter.convert(observation));
    if (scan->cloud.empty()) throw std::invalid_argument("no point with a usable range");
    m_scan = scan;
  } catch (const std::exception& e) {
    m_scan = nullptr;
    m_refusal = e.what();
    if (m_refusal != refusalBefore)
      logger.logStr(mrpt::system::LVL_WARN, "No likelihood: " + m_refusal);
  }
}

void LikelihoodCache::clear() {
  const std::lock_guard lock(m_mutex);
  m_converter.reset();
  m_scan.reset();
  m_refusal.clear();
}

}  // namespace semantic_map
