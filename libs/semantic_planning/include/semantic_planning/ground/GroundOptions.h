#pragma once
#include <strict_files/OptionList.h>

namespace semantic_planning {

/** How the ground is read from the map. */
struct GroundOptions {
  /** Holes in the ground up to this wide (m) get the class of the nearer border: between a LiDAR's
   * rings, and where grazing beams eroded a voxel. A hole is filled along lines between two of its
   * borders. Their slope must be drivable, nothing may stand in the way, and the map must not have
   * seen free space below. */
  double fillGap = 0.8;
  /** Wider holes up to this (meters) are filled too: the vehicle's own shadow at the start, what
   * parked cars hid. Between borders of one
   * rank they have the class of the nearer one, too, otherwise their ground is of unknown class.
   * For tests; it has no name in files. */
  double unknownGap = 4.0;
  /** Whether ground of a forbidden class keeps the whole footprint off, or the wheels only. */
  bool keepOff = false;

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

}  // namespace semantic_planning
