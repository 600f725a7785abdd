#include <synthetic_world/Sensors.h>

namespace synthetic_world {

void SensorNoise::describe(strict_files::OptionList& list) {
  using strict_files::between;
  list.add("range_noise", range, "m", strict_files::atLeast(0),
           "standard deviation of ranges and depths");
  list.add("label_noise", label, "", between(0, 1), "share of labels that are of another class");
  list.add("dropout", dropout, "", between(0, 1), "share of rays without a return");
}

void SensorNoise::validate() const { strict_files::checkOptions(*this, "SensorNoise"); }

ClassId SensorNoise::disturbed(ClassId id, Random& random) const {
  if (id == kNoClass || label == 0 || !random.chance(label)) return id;
  const auto other = static_cast<ClassId>(1 + random.below(kClassCount - 1));
  return other < id ? other : static_cast<ClassId>(other + 1);
}

}  // namespace synthetic_world
