#pragma once
#include <cstdint>

namespace semantic_planning {

/** A number in [0, 1) that looks random: mixes the bits of three (the finalizer of MurmurHash3). */
inline double unitHash(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  std::uint32_t h = a * 0x9e3779b1u ^ b * 0x85ebca77u ^ c * 0xc2b2ae3du;
  h = (h ^ (h >> 16)) * 0x85ebca6bu;
  h = (h ^ (h >> 13)) * 0xc2b2ae35u;
  return (h ^ (h >> 16)) / 4294967296.0;
}

}  // namespace semantic_planning
