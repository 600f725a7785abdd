#include <semantic_planning/GroundOptions.h>

#include "OptionChecks.h"

namespace semantic_planning {

void GroundOptions::validate() const {
  const OptionChecks check("GroundOptions");
  check.within("bridgeGap", bridgeGap, 0, 20);
  check.within("unknownGap", unknownGap, 0, 20);
}

}  // namespace semantic_planning
