#include <semantic_planning/ground/GroundOptions.h>

#include <strict_files/OptionChecks.h>

namespace semantic_planning {

void GroundOptions::validate() const {
  const strict_files::OptionChecks check("GroundOptions");
  check.within("fillGap", fillGap, 0, 20);
  check.within("unknownGap", unknownGap, 0, 20);
}

}  // namespace semantic_planning
