#include <semantic_planning/roadmap/ClassReading.h>

#include <strict_files/OptionChecks.h>

namespace semantic_planning {

void ClassReading::validate() const {
  if (!(bound > 0 && bound < 1))
    strict_files::OptionChecks("ClassReading").fail("bound", "must be between 0 and 1");
}

}  // namespace semantic_planning
