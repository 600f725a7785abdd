#include <semantic_planning/ClassReading.h>

#include "OptionChecks.h"

namespace semantic_planning {

void ClassReading::validate() const {
  if (!(bound > 0 && bound < 1))
    OptionChecks("ClassReading").fail("bound", "must be between 0 and 1");
}

}  // namespace semantic_planning
