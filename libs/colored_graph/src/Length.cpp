#include <colored_graph/Edge.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace colored_graph {
namespace {

constexpr double kNoise = 1e-6;      // units
constexpr double kLargest = 0x1p62;  // units

double inUnits(double meters) {
  const double units = meters * kLengthUnitsPerMeter;
  if (!(units >= 0 && units <= kLargest))
    throw std::invalid_argument("length: " + std::to_string(meters) +
                                " m is not between 0 and 4.6e14 m");
  return units;
}

}  // namespace

Length lengthUp(double meters) {
  return static_cast<Length>(std::ceil(std::max(0.0, inUnits(meters) - kNoise)));
}

Length lengthDown(double meters) {
  return static_cast<Length>(std::floor(inUnits(meters) + kNoise));
}

}  // namespace colored_graph
