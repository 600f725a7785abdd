#pragma once
#include <cstdint>

namespace semantic_octree {

/** Bits set in some words. */
unsigned countBits(const std::uint64_t* words, int numWords);

/** Bits set in front of a bit. */
unsigned countBitsBefore(const std::uint64_t* words, unsigned bit);

}  // namespace semantic_octree
