#include <semantic_planning/ground/GroundOptions.h>

namespace semantic_planning {

void GroundOptions::describe(strict_files::OptionList& list) {
  const strict_files::Range gap = strict_files::between(0, 20);
  list.add("fill_gap", fillGap, "m", gap,
           "holes in the ground up to this get their border's class");
  list.add("keep_off", keepOff, "",
           "the whole footprint keeps off forbidden classes, not only the wheels");
}

void GroundOptions::validate() const { strict_files::checkOptions(*this, "GroundOptions"); }

}  // namespace semantic_planning
