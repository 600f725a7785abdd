#include <synthetic_world/SensorNoise.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace synthetic_world {
namespace {

void requireShare(double value, const char* field) {
  if (!(value >= 0 && value <= 1))
    throw std::invalid_argument(std::string("sensor noise: ") + field + " is " +
                                std::to_string(value) + ", 0 to 1 expected");
}

}  // namespace

void SensorNoise::validate() const {
  if (!(range >= 0) || !std::isfinite(range))
    throw std::invalid_argument("sensor noise: range is " + std::to_string(range) +
                                ", 0 m or more expected");
  requireShare(label, "label");
  requireShare(dropout, "dropout");
}

ClassId SensorNoise::disturbed(ClassId id, Random& random) const {
  if (id == kNoClass || label == 0 || !random.chance(label)) return id;
  const auto other = static_cast<ClassId>(1 + random.below(kClassCount - 1));
  return other < id ? other : static_cast<ClassId>(other + 1);
}

}  // namespace synthetic_world
