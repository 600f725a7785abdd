#include <semantic_planning/roadmap/ClassReading.h>

#include <strict_files/OptionChecks.h>

namespace semantic_planning {

void ClassReading::validate() const {
  if (!(leastProbability > 0 && leastProbability < 1))
    strict_files::OptionChecks("ClassReading").fail("leastProbability", "must be between 0 and 1");
}

}  // namespace semantic_planning
