#include <semantic_octree/store/BlockUpdate.h>

#include <semantic_octree/store/Lanes.h>

namespace semantic_octree {

template class BlockUpdate<ClassFilter<float>>;

MSO_VECTORIZED Block::Count Block::count() const {
  const std::uint8_t any = octantsWith(known);
  // The leaves' bits, one in each octant, then all of its.
  VoxelBits leaves = leafOctants * VoxelBits(0x0101010101010101) & 0x8040201008040201;
  leaves = ((leaves + 0x7f7f7f7f7f7f7f7f) >> 7 & 0x0101010101010101) * 0xff;
  return {countOf(any) + countOf(known & ~leaves),
          countOf(static_cast<std::uint8_t>(any & ~leafOctants))};
}

namespace {

constexpr int kLanesOfUnits = 16;
using UnitVector = Units __attribute__((vector_size(32)));

MSO_INLINE UnitVector ofAll(Units value) { return UnitVector{} + value; }

/** The nearest that 16 bits hold. */
Units nearest(int units) {
  return static_cast<Units>(std::min<int>(INT16_MAX, std::max<int>(-INT16_MAX, units)));
}

}  // namespace

MSO_VECTORIZED void missWhere(Units* values, std::uint64_t where, const UnitIncrement& by) {
  UnitVector bitOfLane;
  for (int i = 0; i < kLanesOfUnits; ++i) bitOfLane[i] = static_cast<Units>(1u << i);
  // Limits are kept before adding, so that nothing overflows.
  const UnitVector low = ofAll(nearest(by.lowest - by.increment)),
                   high = ofAll(nearest(by.highest - by.increment)), unknown = ofAll(kUnknown),
                   zero = {};
  for (int i = 0; i < 64; i += kLanesOfUnits, where >>= kLanesOfUnits) {
    UnitVector old;
    std::memcpy(&old, values + i, sizeof old);
    UnitVector sum = old == unknown ? zero : old;
    sum = sum < low ? low : sum;
    sum = sum > high ? high : sum;
    sum += by.increment;
    const UnitVector bits = ofAll(static_cast<Units>(where)) & bitOfLane;
    const UnitVector result = bits == zero ? old : sum;
    std::memcpy(values + i, &result, sizeof result);
  }
}

}  // namespace semantic_octree
