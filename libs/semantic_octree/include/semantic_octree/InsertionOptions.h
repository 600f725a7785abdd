#pragma once
#include <semantic_octree/LabelReliability.h>
#include <strict_files/OptionList.h>

#include <cstddef>

namespace semantic_octree {

/** How a scan is inserted. */
struct InsertionOptions {
  enum class Rays {
    /** Every ray carves (exact). */
    All,
    /** One ray per end voxel carves, to its center: faster, nearly the same map. */
    EndVoxels
  };
  Rays rays = Rays::All;
  /** Meters. Returns beyond it only carve free space up to it. 0: no limit. */
  double maxRange = 0;
  /** Meters. Returns nearer than this (the robot itself) are ignored. */
  double minRange = 0;
  /** Meters before a return that are not carved: what a grazing ray passes just before its end
   * often belongs to the surface that it hits. 0: carve up to the voxel of the return. */
  double carvingMargin = 0;
  /** Threads that share the work; the map does not depend on it. */
  int threads = 1;
  /** MB (10^6 bytes). A scan that needs more buffers than this, because its points are too far from
   * each other, is refused. */
  int maxScanMemory = 2000;

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};
const strict_files::Choices<InsertionOptions::Rays>& choicesOf(InsertionOptions::Rays);

/** What became of a scan. */
struct InsertionReport {
  std::size_t points = 0;            ///< in the cloud
  std::size_t skippedNotFinite = 0;  ///< NaN or infinite
  std::size_t skippedNear = 0;       ///< nearer than minRange
  std::size_t skippedOutside = 0;    ///< end outside the map's 16 levels
  std::size_t beyondRange = 0;       ///< carved only
  std::size_t hitVoxels = 0, freeVoxels = 0;
  LabelReliability labels{};  ///< how far its labels were trusted
};

}  // namespace semantic_octree
