#include <semantic_octree/store/HitVotes.h>

#include <algorithm>
#include <utility>

namespace semantic_octree {

using semantic_types::LabeledCloud;

void HitVotes::count(const LabeledCloud& cloud, const std::vector<std::uint32_t>& voxels,
                     std::size_t numVoxels, int numClasses) {
  m_numClasses = numClasses;
  const bool soft = !cloud.probabilities.empty();
  m_softSums.assign(soft ? numVoxels * numClasses : 0, 0.f);
  m_softCounts.assign(soft ? numVoxels : 0, 0);
  m_labels.clear();
  m_endsOfLabels.assign(numVoxels, 0);
  m_agreement = {};
  if (soft)
    addSoftLabels(cloud, voxels);
  else if (!cloud.classes.empty())
    collectLabels(cloud, voxels);
}

void HitVotes::collectLabels(const LabeledCloud& cloud, const std::vector<std::uint32_t>& voxels) {
  const auto forEachLabel = [&](const auto& f) {
    for (std::size_t i = 0; i < voxels.size(); ++i)
      if (voxels[i] != kNowhere && cloud.classes[i] != kNoClass) f(voxels[i], cloud.classes[i]);
  };
  // A counting sort: how many each has, where each begins, and, once all are in place, ends.
  forEachLabel([&](std::uint32_t voxel, ClassId) { ++m_endsOfLabels[voxel]; });
  std::uint32_t begin = 0;
  for (std::uint32_t& n : m_endsOfLabels) begin += std::exchange(n, begin);
  m_labels.resize(begin);
  forEachLabel([&](std::uint32_t voxel, ClassId id) { m_labels[m_endsOfLabels[voxel]++] = id; });
  begin = 0;
  for (const std::uint32_t end : m_endsOfLabels) {
    std::sort(m_labels.begin() + begin, m_labels.begin() + end);
    m_agreement.add(m_labels.data() + begin, m_labels.data() + end);
    begin = end;
  }
}

HitVotes::Result HitVotes::votesOf(std::uint32_t voxel) const {
  Result result;
  const std::uint32_t end = m_endsOfLabels[voxel];
  for (std::uint32_t i = firstLabel(voxel); i < end; ++i) {
    if (result.numVoted == 0 || result.votes[result.numVoted - 1].id != m_labels[i])
      result.votes[result.numVoted++] = {m_labels[i], 0};
    ++result.votes[result.numVoted - 1].count;
  }
  return result;
}

void HitVotes::addSoftLabels(const LabeledCloud& cloud, const std::vector<std::uint32_t>& voxels) {
  const auto K = static_cast<std::size_t>(m_numClasses);
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    const float* const q = cloud.probabilities.data() + i * K;
    if (voxels[i] == kNowhere || std::all_of(q, q + K, [](float p) { return p == 0; })) continue;
    float* const sum = m_softSums.data() + voxels[i] * K;
    for (std::size_t k = 0; k < K; ++k) sum[k] += q[k];
    ++m_softCounts[voxels[i]];
  }
  for (std::size_t voxel = 0; voxel < m_softCounts.size(); ++voxel)
    for (std::size_t k = 0; m_softCounts[voxel] > 1 && k < K; ++k)
      m_softSums[voxel * K + k] /= static_cast<float>(m_softCounts[voxel]);
}

void HitVotes::begin(int numClasses) {
  m_numClasses = numClasses;
  m_labels.clear();
  m_endsOfLabels.clear();
  m_softSums.clear();
  m_softCounts.clear();
}

void HitVotes::add(const ClassVotes* votes, std::size_t numVoted) {
  for (std::size_t i = 0; i < numVoted; ++i)
    m_labels.insert(m_labels.end(), votes[i].count, votes[i].id);
  m_endsOfLabels.push_back(static_cast<std::uint32_t>(m_labels.size()));
}

void HitVotes::add(const float* softLabel) {
  m_softCounts.push_back(softLabel != nullptr);
  if (softLabel)
    m_softSums.insert(m_softSums.end(), softLabel, softLabel + m_numClasses);
  else
    m_softSums.resize(m_softSums.size() + m_numClasses, 0.f);
  m_endsOfLabels.push_back(0);
}

}  // namespace semantic_octree
