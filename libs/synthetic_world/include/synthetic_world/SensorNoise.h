#pragma once
#include <strict_files/OptionList.h>
#include <synthetic_world/Classes.h>
#include <synthetic_world/Random.h>

#include <cstdint>

namespace synthetic_world {

/** What a sensor gets wrong. All zero: nothing. */
struct SensorNoise {
  double range = 0;    // standard deviation of ranges and depths, m
  double label = 0;    // share of labels replaced by one of the other classes at random, 0..1
  double dropout = 0;  // share of rays without a return, 0..1

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the field. */
  void validate() const;

  bool drops(Random& random) const { return dropout > 0 && random.chance(dropout); }
  double disturbed(double meters, Random& random) const {
    return range > 0 ? meters + range * random.normal() : meters;
  }
  ClassId disturbed(ClassId id, Random& random) const;
};

/** Which of the many random choices a sensor makes: the same seed and frame, the same noise. */
struct FrameSeed {
  std::uint64_t seed = 1, frame = 0;
};

}  // namespace synthetic_world
