#pragma once
#include <semantic_planning/vehicle/PathPoint.h>

#include "LatticeSearch.h"

namespace semantic_planning {

/** Poses at the places of a path: its ends, where the gear changes, and between; with its own
 * headings and those towards places farther along it. */
std::vector<Station> stationsOn(const std::vector<PathPoint>& path,
                                const CollisionChecker& checker);

struct BesideOptions {
  double sideways, turn;   ///< to both sides of the path and of the direction of travel; m, radians
  bool atGearChangesOnly;  ///< and near them
};

/** The poses of a path and others beside them that the vehicle fits at; its ends stay as they are.
 */
std::vector<Station> stationsBeside(const std::vector<PathPoint>& path,
                                    const CollisionChecker& checker, const BesideOptions& options);

}  // namespace semantic_planning
