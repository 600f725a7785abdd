#pragma once
#include <semantic_types/LabeledCloud.h>
#include <cstdint>
#include <vector>

namespace semantic_octree {

/** The class of each hit voxel of a scan, from the points that end in it: the majority (the lowest
 * id on a tie), points without a class do not vote. With soft labels, their mean.
 *
 * Voxels are known by their rank among the scan's hit voxels. */
class HitVotes {
 public:
  /** \param numClasses K, used with soft labels only. */
  void start(std::size_t numVoxels, const semantic_types::LabeledCloud& cloud, int numClasses);
  void add(std::uint32_t voxel, std::uint32_t point);
  void finish();

  semantic_types::ClassId classOf(std::uint32_t voxel) const { return m_classes[voxel]; }
  /** Mean of the soft labels, K probabilities; null if there are none for this voxel. */
  const float* softLabelOf(std::uint32_t voxel) const {
    if (m_softSums.empty() || m_softCounts[voxel] == 0) return nullptr;
    return m_softSums.data() + static_cast<std::size_t>(voxel) * m_numClasses;
  }

 private:
  /** Voxel above class, in one number: quick to sort. */
  struct Ballot {
    std::uint64_t value;
    Ballot(std::uint32_t voxel, semantic_types::ClassId id)
        : value(std::uint64_t(voxel) << 16 | id) {}
    std::uint32_t voxel() const { return static_cast<std::uint32_t>(value >> 16); }
    semantic_types::ClassId id() const {
      return static_cast<semantic_types::ClassId>(value & 0xffff);
    }
  };
  void addSoft(std::uint32_t voxel, std::uint32_t point);
  void settleMixed();

  const semantic_types::LabeledCloud* m_cloud = nullptr;
  int m_numClasses = 0;
  std::vector<semantic_types::ClassId> m_classes;
  std::vector<Ballot> m_ballots;      ///< every vote, to recount where voxels are mixed
  std::vector<std::uint8_t> m_mixed;  ///< points of several classes
  std::vector<float> m_softSums;
  std::vector<std::uint32_t> m_softCounts;
};

}  // namespace semantic_octree
