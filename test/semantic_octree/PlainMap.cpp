#include "PlainMap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

using namespace semantic_octree;

namespace {

VoxelId voxelOf(const Eigen::Array3d& u) {
  return {static_cast<int>(std::floor(u[0])), static_cast<int>(std::floor(u[1])),
          static_cast<int>(std::floor(u[2]))};
}

/** All crossings of voxel borders, sorted along the ray; each leaves one voxel. */
void carve(const Eigen::Array3d& begin, const Eigen::Array3d& end, std::set<VoxelId>& free) {
  const VoxelId first = voxelOf(begin), last = voxelOf(end);
  std::vector<std::tuple<double, int>>
      crossings;  // position along the ray, axis (z first on a tie)
  for (int axis = 0; axis < 3; ++axis) {
    const int lowest = std::min(first[axis], last[axis]),
              highest = std::max(first[axis], last[axis]);
    for (int border = lowest + 1; border <= highest; ++border)
      crossings.emplace_back((border - begin[axis]) / (end[axis] - begin[axis]), 2 - axis);
  }
  std::sort(crossings.begin(), crossings.end());
  VoxelId v = first;
  for (const auto& [t, reversedAxis] : crossings) {
    const int axis = 2 - reversedAxis;
    free.insert(v);
    v[axis] += last[axis] > first[axis] ? 1 : -1;
  }
}

}  // namespace

PlainScan plainScan(const PosedCloud& scan, double resolution, const InsertionOptions& options) {
  PlainScan result;
  std::set<VoxelId> carvedEnds[2];
  const Eigen::Array3d begin = scan.T_map_sensor.translation().array() * (1 / resolution);
  const double maxRange = options.maxRange > 0 ? options.maxRange : HUGE_VAL;
  for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
    const Eigen::Vector3d p = scan.cloud.points[i].cast<double>();
    const double range = p.norm();
    if (!std::isfinite(range) || range < options.minRange) continue;
    const bool isReturn = range <= maxRange;
    const Eigen::Vector3d beam = scan.T_map_sensor.linear() * p * (isReturn ? 1 : maxRange / range);
    Eigen::Array3d end = begin + beam.array() / resolution;
    if ((end < -kKeyOfOrigin).any() || (end >= kKeyOfOrigin).any()) continue;
    const VoxelId endVoxel = voxelOf(end);
    if (isReturn) result.hits[endVoxel].push_back(i);
    if (options.rays == InsertionOptions::Rays::EndVoxels) {
      if (!carvedEnds[isReturn].insert(endVoxel).second) continue;
      end = end.floor() + 0.5;
    }
    if (isReturn && options.carvingMargin > 0) {
      const double length = (end - begin).matrix().norm() * resolution;
      if (length <= options.carvingMargin) continue;
      end = begin + (end - begin) * (1 - options.carvingMargin / length);
    }
    carve(begin, end, result.free);
  }
  for (const auto& hit : result.hits) result.free.erase(hit.first);
  return result;
}

LabelReliability PlainMap::reliabilityOf(const PlainScan& plain, const LabeledCloud& cloud) const {
  LabelAgreement agreement;
  for (const auto& [id, points] : plain.hits) {
    std::vector<ClassId> labels;
    for (const std::size_t i : points)
      if (!cloud.classes.empty() && cloud.classes[i] != kNoClass)
        labels.push_back(cloud.classes[i]);
    std::sort(labels.begin(), labels.end());
    if (cloud.probabilities.empty()) agreement.add(labels.data(), labels.data() + labels.size());
  }
  return agreement.explain(m_parameters, numClasses());
}

void PlainMap::insert(const PosedCloud& scan, const InsertionOptions& options) {
  const PlainScan plain = plainScan(scan, m_resolution, options);
  const LabelReliability labels = reliabilityOf(plain, scan.cloud);
  FilterParameters ofScan = m_parameters;
  ofScan.accuracy = labels.accuracy, ofScan.labelCorrelation = labels.correlation;
  const ClassFilter filter(numClasses(), ofScan);
  for (const auto& [id, points] : plain.hits) {
    Voxel& v = voxel(id);
    scan.cloud.probabilities.empty() ? hit(v, points, scan.cloud, filter)
                                     : hitSoft(v, points, scan.cloud);
  }
  for (const VoxelId& id : plain.free) miss(voxel(id));
}

PlainMap::Voxel& PlainMap::voxel(const VoxelId& id) { return m_voxels[id]; }

void PlainMap::hit(Voxel& v, const std::vector<std::size_t>& points, const LabeledCloud& cloud,
                   const ClassFilter& filter) const {
  std::map<int, int> votes;
  for (const std::size_t i : points)
    if (!cloud.classes.empty() && cloud.classes[i] != kNoClass) ++votes[cloud.classes[i]];
  if (votes.empty()) return hitUnlabeled(v);
  if (!v.record) v.record = m_filter.uniform(v.value);
  std::vector<ClassVotes> ascending;
  for (const auto& [id, count] : votes) {
    ascending.push_back({static_cast<ClassId>(id), static_cast<std::uint32_t>(count)});
  }
  filter.hit(*v.record, ascending.data(), ascending.size());
  v.value = m_filter.occupancyOf(*v.record);
}

void PlainMap::hitSoft(Voxel& v, const std::vector<std::size_t>& points,
                       const LabeledCloud& cloud) const {
  std::vector<float> mean(numClasses());
  int count = 0;
  for (const std::size_t i : points) {
    const float* q = &cloud.probabilities[i * numClasses()];
    float sum = 0;
    for (int k = 0; k < numClasses(); ++k) mean[k] += q[k], sum += q[k];
    count += sum > 0;
  }
  if (count == 0) return hitUnlabeled(v);
  for (float& q : mean) q /= static_cast<float>(count);
  if (!v.record) v.record = m_filter.uniform(v.value);
  m_filter.hit(*v.record, mean.data());
  v.value = m_filter.occupancyOf(*v.record);
}

void PlainMap::hitUnlabeled(Voxel& v) const {
  if (v.record) {
    m_filter.hit(*v.record);
    v.value = m_filter.occupancyOf(*v.record);
  } else {
    v.value = m_filter.occupancyAfterUnlabeledHit(v.value);
  }
}

void PlainMap::miss(Voxel& v) const {
  if (!v.record) {
    v.value = m_filter.occupancyAfterMiss(v.value);
    return;
  }
  m_filter.miss(*v.record);
  v.value = m_filter.occupancyOf(*v.record);
  if (!v.record->isUniform() || m_filter.uniform(m_filter.lowestOccupancy()).rest < v.record->rest)
    return;
  v.value = m_filter.lowestOccupancy();
  v.record.reset();
}

void expectSame(const SemanticOcTree& tree, const PlainMap& plain) {
  std::size_t missing = 0, otherValue = 0, otherRecord = 0;
  for (const auto& [id, voxel] : plain.voxels()) {
    const auto node = tree.search(keyOf(id));
    if (!node) {
      ++missing;
      continue;
    }
    otherValue += node->getLogOdds() != voxel.value;
    otherRecord += node->hasClassRecord() != voxel.record.has_value() ||
                   (voxel.record && !(tree.belief(*node) == *voxel.record));
  }
  EXPECT_EQ(missing, 0u);
  EXPECT_EQ(otherValue, 0u);
  EXPECT_EQ(otherRecord, 0u);
  std::size_t known = 0;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf)
    known += std::size_t(1) << 3 * (16 - leaf.getDepth());
  EXPECT_EQ(known, plain.voxels().size());
}
