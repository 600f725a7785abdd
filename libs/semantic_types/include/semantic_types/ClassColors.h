#pragma once
#include <semantic_types/ClassTable.h>

#include <algorithm>
#include <cstdint>

namespace semantic_types {

/** Whatever is drawn where no class was ever seen. */
constexpr Color kColorWithoutClass{150, 150, 150};

/** A class's color, or the gray of those without. \throw std::out_of_range id is not 0..K. */
inline Color colorOf(ClassId id, const ClassTable& classes) {
  return id == kNoClass ? kColorWithoutClass : classes.color(id);
}

/** Red (0) over yellow to green (1). */
inline Color trafficLight(double value) {
  const double v = std::clamp(value, 0.0, 1.0);
  const auto byteOf = [](double x) { return static_cast<std::uint8_t>(x + 0.5); };
  return {byteOf(235 * std::min(1.0, 2 - 2 * v)), byteOf(215 * std::min(1.0, 2 * v)), 30};
}

}  // namespace semantic_types
