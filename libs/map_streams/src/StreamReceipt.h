#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace semantic_octree {

/** What came of a revision: all packets up to one, and which of those behind it. */
struct StreamReceipt {
  std::uint16_t revision = 0;  ///< 0: nothing at all
  std::uint32_t sequence = 0;  ///< the highest that came
  std::uint32_t prefix = 0;    ///< so many from the first on
  std::string behind;          ///< a bit each, the lowest first

  bool has(std::size_t number) const {
    if (number < prefix) return true;
    const std::size_t i = number - prefix;
    return i / 8 < behind.size() && (behind[i / 8] >> i % 8 & 1);
  }
  /** The packets that it speaks of, from the first on. */
  std::size_t numPackets() const { return prefix + 8 * behind.size(); }

  /** A receipt of the prefix and of the 7200 packets behind it, which fit into a datagram. */
  static StreamReceipt of(std::uint16_t revision, std::uint32_t sequence,
                          const std::vector<bool>& came, std::uint32_t prefix);
  std::string bytes() const;
  /** \throw std::runtime_error too short. */
  static StreamReceipt of(const std::string& bytes);
};

}  // namespace semantic_octree
