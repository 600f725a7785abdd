#include "HitVotes.h"

#include <algorithm>

namespace semantic_octree {

using semantic_types::ClassId;
using semantic_types::kNoClass;
using semantic_types::LabeledCloud;

void HitVotes::start(std::size_t numVoxels, const LabeledCloud& cloud, int numClasses) {
  m_cloud = &cloud;
  m_numClasses = numClasses;
  m_classes.assign(numVoxels, kNoClass);
  m_mixed.assign(numVoxels, 0);
  m_ballots.clear();
  const std::size_t soft = cloud.probabilities.empty() ? 0 : numVoxels;
  m_softSums.assign(soft * numClasses, 0.f);
  m_softCounts.assign(soft, 0);
}

void HitVotes::add(std::uint32_t voxel, std::uint32_t point) {
  if (!m_softSums.empty()) return addSoft(voxel, point);
  const ClassId id = m_cloud->classes.empty() ? kNoClass : m_cloud->classes[point];
  if (id == kNoClass) return;
  m_ballots.emplace_back(voxel, id);
  ClassId& first = m_classes[voxel];
  if (first == kNoClass)
    first = id;
  else if (first != id)
    m_mixed[voxel] = 1;
}

void HitVotes::addSoft(std::uint32_t voxel, std::uint32_t point) {
  const float* q = m_cloud->probabilities.data() + static_cast<std::size_t>(point) * m_numClasses;
  if (std::all_of(q, q + m_numClasses, [](float p) { return p == 0; })) return;
  float* sum = m_softSums.data() + static_cast<std::size_t>(voxel) * m_numClasses;
  for (int k = 0; k < m_numClasses; ++k) sum[k] += q[k];
  ++m_softCounts[voxel];
}

void HitVotes::finish() {
  settleMixed();
  for (std::size_t voxel = 0; voxel < m_softCounts.size(); ++voxel)
    for (int k = 0; m_softCounts[voxel] > 1 && k < m_numClasses; ++k)
      m_softSums[voxel * m_numClasses + k] /= static_cast<float>(m_softCounts[voxel]);
}

void HitVotes::settleMixed() {
  m_ballots.erase(std::remove_if(m_ballots.begin(), m_ballots.end(),
                                 [this](const Ballot& b) { return !m_mixed[b.voxel()]; }),
                  m_ballots.end());
  std::sort(m_ballots.begin(), m_ballots.end(),
            [](const Ballot& a, const Ballot& b) { return a.value < b.value; });
  std::size_t mostVotes = 0;
  for (std::size_t i = 0, end; i < m_ballots.size(); i = end) {
    const Ballot& b = m_ballots[i];
    for (end = i; end < m_ballots.size() && m_ballots[end].value == b.value;) ++end;
    if (i == 0 || m_ballots[i - 1].voxel() != b.voxel()) mostVotes = 0;
    if (end - i <= mostVotes) continue;
    mostVotes = end - i;
    m_classes[b.voxel()] = b.id();
  }
}

}  // namespace semantic_octree
