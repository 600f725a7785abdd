#include <semantic_driving/DriveOptions.h>

#include <algorithm>

#include <strict_files/OptionChecks.h>

namespace semantic_driving {

void DriveOptions::validate() const {
  const strict_files::OptionChecks check("DriveOptions");
  check.positive("maxSpeed", maxSpeed);
  check.positive("maxAcceleration", maxAcceleration);
  check.positive("maxSideAcceleration", maxSideAcceleration);
  check.positive("turningRadius", turningRadius);
  check.notNegative("margin", margin);
  check.positive("lookAhead", lookAhead);
  check.notNegative("exactEnd", exactEnd);
  check.positive("maxSensorAge", maxSensorAge);
}

double DriveOptions::speedFor(double sensorAge) const {
  return maxSpeed * std::clamp(1.5 - sensorAge / (2 * maxSensorAge), 0.0, 1.0);
}

}  // namespace semantic_driving
