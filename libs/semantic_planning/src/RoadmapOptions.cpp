#include <semantic_planning/RoadmapOptions.h>

#include "OptionChecks.h"

namespace semantic_planning {

void RoadmapOptions::validate() const {
  const OptionChecks check("RoadmapOptions");
  check.within("neighbors", neighbors, 1, 1000);
  check.positive("connectionRadius", connectionRadius);
  check.within("headings", headings, 1, 360);
  check.positive("spacing", spacing);
  if (!(regionBuffer >= 0)) check.notNegative("regionBuffer", regionBuffer);
}

}  // namespace semantic_planning
