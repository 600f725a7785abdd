#include "HitVotes.h"

#include <algorithm>

namespace semantic_octree {

using semantic_types::LabeledCloud;

void HitVotes::start(std::size_t numVoxels, const LabeledCloud& cloud, int numClasses) {
  m_cloud = &cloud;
  m_numClasses = numClasses;
  m_polls.assign(numVoxels, Poll());
  m_ballots.clear();
  m_mixedVotes.clear();
  const std::size_t soft = cloud.probabilities.empty() ? 0 : numVoxels;
  m_softSums.assign(soft * numClasses, 0.f);
  m_softCounts.assign(soft, 0);
}

void HitVotes::add(std::uint32_t voxel, std::uint32_t point) {
  if (!m_softSums.empty()) return addSoft(voxel, point);
  const ClassId id = m_cloud->classes.empty() ? kNoClass : m_cloud->classes[point];
  if (id == kNoClass) return;
  m_ballots.emplace_back(voxel, id);
  Poll& poll = m_polls[voxel];
  if (poll.numVoted == 0) {
    poll.first.id = id;
    poll.numVoted = 1;
  }
  if (poll.first.id == id)
    ++poll.first.count;
  else
    poll.numVoted = 2;  // at least; to be counted
}

void HitVotes::addSoft(std::uint32_t voxel, std::uint32_t point) {
  const float* q = m_cloud->probabilities.data() + static_cast<std::size_t>(point) * m_numClasses;
  if (std::all_of(q, q + m_numClasses, [](float p) { return p == 0; })) return;
  float* sum = m_softSums.data() + static_cast<std::size_t>(voxel) * m_numClasses;
  for (int k = 0; k < m_numClasses; ++k) sum[k] += q[k];
  ++m_softCounts[voxel];
}

void HitVotes::finish() {
  countMixed();
  for (std::size_t voxel = 0; voxel < m_softCounts.size(); ++voxel)
    for (int k = 0; m_softCounts[voxel] > 1 && k < m_numClasses; ++k)
      m_softSums[voxel * m_numClasses + k] /= static_cast<float>(m_softCounts[voxel]);
}

void HitVotes::countMixed() {
  m_ballots.erase(
      std::remove_if(m_ballots.begin(), m_ballots.end(),
                     [this](const Ballot& b) { return m_polls[b.voxel()].numVoted == 1; }),
      m_ballots.end());
  std::sort(m_ballots.begin(), m_ballots.end(),
            [](const Ballot& a, const Ballot& b) { return a.value < b.value; });
  for (std::size_t i = 0; i < m_ballots.size(); ++i) {
    const Ballot& b = m_ballots[i];
    Poll& poll = m_polls[b.voxel()];
    if (i == 0 || m_ballots[i - 1].voxel() != b.voxel()) {
      poll.mixedVotes = static_cast<std::uint32_t>(m_mixedVotes.size());
      poll.numVoted = 0;
    }
    if (poll.numVoted == 0 || m_mixedVotes.back().id != b.id()) {
      m_mixedVotes.push_back({b.id(), 0});
      ++poll.numVoted;
    }
    ++m_mixedVotes.back().count;
  }
}

}  // namespace semantic_octree
