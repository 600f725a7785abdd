#pragma once
#include <semantic_driving/DrivePath.h>
#include <semantic_planning/planner/SemanticPlanner.h>
#include <strict_files/OptionList.h>

namespace semantic_driving {

/** How ways out of where a vehicle must not be are looked for. */
struct RecoveryOptions {
  double radius = 8;    ///< how far, meters
  double blind = 2;     ///< sensors may not see the ground nearer than this, meters
  double step = 0.4;    ///< between distances of places that are tried, meters
  int directions = 16;  ///< in which they lie
  int headings = 8;     ///< of each place
  double same = 0.1;    ///< meters of forbidden ground that make no difference
  /** Meters beyond the least way over forbidden ground that a shorter one is looked for. */
  double further = 2;

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

/** From where a vehicle must not be, a way to where it may: over ground of a forbidden class, or
 * too close to something. Of all Reeds-Shepp curves to places between `nearest` and the radius
 * from which the planner can plan, one with the least way over forbidden ground, and of those a
 * shortest one. The curve keeps the footprint free, but no clearance. Empty if there is none.
 * \param z height of the ground below the vehicle, meters \param nearest meters
 * \throw std::invalid_argument bad options. */
DrivePath findRecovery(const semantic_planning::SemanticPlanner& planner,
                       const mrpt::math::TPose2D& from, double z,
                       const RecoveryOptions& options = {}, double nearest = 0);

}  // namespace semantic_driving
