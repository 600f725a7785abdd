#include "BitCounts.h"

#include "Lanes.h"

namespace semantic_octree {
namespace {

/** One instruction where it is compiled for a processor that has it. */
MSO_INLINE unsigned count(const std::uint64_t* words, unsigned numWords) {
  unsigned bits = 0;
  for (unsigned w = 0; w < numWords; ++w) bits += __builtin_popcountll(words[w]);
  return bits;
}

}  // namespace

MSO_VECTORIZED unsigned countBits(const std::uint64_t* words, int numWords) {
  return count(words, numWords);
}

MSO_VECTORIZED unsigned countBitsBefore(const std::uint64_t* words, unsigned bit) {
  const std::uint64_t below = (std::uint64_t(1) << (bit & 63)) - 1;
  return count(words, bit >> 6) + __builtin_popcountll(words[bit >> 6] & below);
}

}  // namespace semantic_octree
