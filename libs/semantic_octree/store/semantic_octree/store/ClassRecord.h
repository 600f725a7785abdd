#pragma once
#include <semantic_octree/ClassFilter.h>

#include <cmath>
#include <cstring>

namespace semantic_octree {

using Belief = ClassBelief;

/** Log-odds in 16 bits: multiples of the filter's unit. */
using Units = std::int16_t;
/** Stands for no value, below all others. */
constexpr Units kUnknown = INT16_MIN;

/** Units of log-odds on the filter's grid; what is out of range becomes the nearest that is not. */
inline Units toUnits(float logOdds) {
  const float limit = INT16_MAX / static_cast<float>(kUnitsPerLogOdds);
  return static_cast<Units>(std::min(limit, std::max(-limit, logOdds)) * kUnitsPerLogOdds);
}
inline float fromUnits(Units units) { return static_cast<float>(units) / kUnitsPerLogOdds; }

/** A ClassBelief, stored. Unused bytes are 0, so that equal beliefs have equal bytes. */
struct ClassRecord {
  Units logOdds[3];
  Units rest;
  ClassId ids[3];
  std::uint8_t count;

  static ClassRecord of(const Belief& b) {
    ClassRecord r{};
    r.count = b.count;
    r.rest = toUnits(b.rest);
    for (int i = 0; i < b.count; ++i) {
      r.logOdds[i] = toUnits(b.logOdds[i]);
      r.ids[i] = b.ids[i];
    }
    return r;
  }
  Belief belief() const {
    Belief b;
    b.count = count;
    b.rest = fromUnits(rest);
    for (int i = 0; i < count; ++i) {
      b.logOdds[i] = fromUnits(logOdds[i]);
      b.ids[i] = ids[i];
    }
    return b;
  }
  bool operator==(const ClassRecord& o) const { return std::memcmp(this, &o, sizeof o) == 0; }
  bool operator!=(const ClassRecord& o) const { return !(*this == o); }
};
static_assert(sizeof(ClassRecord) == 12, "no padding");

}  // namespace semantic_octree
