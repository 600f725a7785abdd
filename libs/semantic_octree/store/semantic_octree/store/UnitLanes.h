#pragma once
#include <semantic_octree/store/ClassRecord.h>

namespace semantic_octree {

/** What is added to log-odds, and their limits. */
struct UnitIncrement {
  Units increment, lowest, highest;
};

/** Adds to those of 64 values whose bits are set, and puts them into the limits; what is unknown
 * counts as 0. */
void missWhere(Units* values, std::uint64_t where, const UnitIncrement& by);

/** Whether eight values are the same. */
inline bool eightEqual(const Units* values) {
  std::uint64_t low, high;
  std::memcpy(&low, values, sizeof low);
  std::memcpy(&high, values + 4, sizeof high);
  return low == high && low == (low << 16 | low >> 48);
}

}  // namespace semantic_octree
