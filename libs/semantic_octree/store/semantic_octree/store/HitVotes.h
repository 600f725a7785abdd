#pragma once
#include <semantic_octree/ClassFilter.h>
#include <semantic_octree/LabelReliability.h>
#include <semantic_types/LabeledCloud.h>

#include <array>
#include <cstdint>
#include <vector>

namespace semantic_octree {

/** How many points that end in each hit voxel of a scan name which class. Points without a class do
 * not vote. With soft labels, their mean.
 *
 * Voxels are known by their rank among the scan's hit voxels. The order of points leaves no trace
 * in votes. */
class HitVotes {
 public:
  /** Stands for no voxel. */
  static constexpr std::uint32_t kNowhere = UINT32_MAX;

  /** \param voxels N, in which each point ends, or kNowhere \param numClasses K */
  void count(const semantic_types::LabeledCloud& cloud, const std::vector<std::uint32_t>& voxels,
             std::size_t numVoxels, int numClasses);

  /** Classes that were voted for, ascending ids. */
  struct Result {
    std::size_t numVoted = 0;
    std::array<ClassVotes, 255> votes;  ///< the first numVoted
  };
  Result votesOf(std::uint32_t voxel) const;
  bool hasVotes(std::uint32_t voxel) const { return firstLabel(voxel) < m_endsOfLabels[voxel]; }
  /** Mean of the soft labels, K probabilities; null if there are none for this voxel. */
  const float* softLabelOf(std::uint32_t voxel) const {
    if (m_softSums.empty() || m_softCounts[voxel] == 0) return nullptr;
    return m_softSums.data() + static_cast<std::size_t>(voxel) * m_numClasses;
  }

  bool isSoft() const { return !m_softCounts.empty(); }
  /** How the labels that were counted agree; none with soft labels. */
  const LabelAgreement& agreement() const { return m_agreement; }
  int numClasses() const { return m_numClasses; }

  /** Forgets all voxels; add() then adds one after the other. */
  void begin(int numClasses);
  /** The next voxel's votes, as votesOf() tells them. */
  void add(const ClassVotes* votes, std::size_t numVoted);
  /** The next voxel's mean of soft labels; null if there are none for it. */
  void add(const float* softLabel);

 private:
  void collectLabels(const semantic_types::LabeledCloud& cloud,
                     const std::vector<std::uint32_t>& voxels);
  void addSoftLabels(const semantic_types::LabeledCloud& cloud,
                     const std::vector<std::uint32_t>& voxels);
  std::uint32_t firstLabel(std::uint32_t voxel) const {
    return voxel == 0 ? 0 : m_endsOfLabels[voxel - 1];
  }

  int m_numClasses = 0;
  /** Voxel by voxel, ascending; where each one's end. */
  std::vector<ClassId> m_labels;
  std::vector<std::uint32_t> m_endsOfLabels;
  std::vector<float> m_softSums;
  std::vector<std::uint32_t> m_softCounts;
  LabelAgreement m_agreement;
};

}  // namespace semantic_octree
