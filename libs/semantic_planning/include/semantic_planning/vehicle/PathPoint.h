#pragma once
#include <mrpt/math/TPose2D.h>
#include <semantic_types/ClassTable.h>

namespace semantic_planning {

/** A pose of the planned path. */
struct PathPoint {
  double x = 0, y = 0, z = 0;  ///< meters, map frame; z of the ground
  double heading = 0;          ///< radians
  double curvature = 0;        ///< 1/m, of the steering: positive to the left, whatever the gear
  bool forward = true;
  semantic_types::ClassId classId =
      semantic_types::kNoClass;  ///< worst under the wheels; kNoClass: unknown
  double arcLength = 0;          ///< meters from the start
};

}  // namespace semantic_planning
