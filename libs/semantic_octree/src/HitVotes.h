#pragma once
#include <semantic_octree/ClassFilter.h>
#include <semantic_types/LabeledCloud.h>

#include <cstdint>
#include <vector>

namespace semantic_octree {

/** What the points that end in each hit voxel of a scan say of its class: how many name which;
 * points without a class do not vote. With soft labels, their mean.
 *
 * Voxels are known by their rank among the scan's hit voxels. The order of points leaves no trace.
 */
class HitVotes {
 public:
  /** \param numClasses K, used with soft labels only. */
  void start(std::size_t numVoxels, const semantic_types::LabeledCloud& cloud, int numClasses);
  void add(std::uint32_t voxel, std::uint32_t point);
  void finish();

  /** Classes that were voted for, ascending ids. */
  struct Result {
    const ClassVotes* votes;
    std::size_t numVoted;  ///< 0: no point has a class
  };
  Result votesOf(std::uint32_t voxel) const {
    const Poll& poll = m_polls[voxel];
    if (poll.numVoted <= 1) return {&poll.first, poll.numVoted};
    return {m_mixedVotes.data() + poll.mixedVotes, poll.numVoted};
  }
  /** Mean of the soft labels, K probabilities; null if there are none for this voxel. */
  const float* softLabelOf(std::uint32_t voxel) const {
    if (m_softSums.empty() || m_softCounts[voxel] == 0) return nullptr;
    return m_softSums.data() + static_cast<std::size_t>(voxel) * m_numClasses;
  }

 private:
  struct Poll {
    ClassVotes first{kNoClass, 0};  ///< all votes where one class was voted for
    std::uint32_t numVoted = 0;
    std::uint32_t mixedVotes = 0;  ///< where several were: index of the first one's votes
  };
  /** Voxel above class, in one number: quick to sort. */
  struct Ballot {
    std::uint64_t value;
    Ballot(std::uint32_t voxel, ClassId id) : value(std::uint64_t(voxel) << 16 | id) {}
    std::uint32_t voxel() const { return static_cast<std::uint32_t>(value >> 16); }
    ClassId id() const { return static_cast<ClassId>(value & 0xffff); }
  };
  void addSoft(std::uint32_t voxel, std::uint32_t point);
  void countMixed();

  const semantic_types::LabeledCloud* m_cloud = nullptr;
  int m_numClasses = 0;
  std::vector<Poll> m_polls;
  std::vector<Ballot> m_ballots;  ///< every vote, to recount where voxels are mixed
  std::vector<ClassVotes> m_mixedVotes;
  std::vector<float> m_softSums;
  std::vector<std::uint32_t> m_softCounts;
};

}  // namespace semantic_octree
