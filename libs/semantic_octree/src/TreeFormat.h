#pragma once
#include <array>
#include <cstdint>

namespace semantic_octree {

/** A map's bytes: kMagic, kVersion, then in checked blocks (see CheckedStream.h)
 *   resolution (double), pruning (1 byte), filter (increments 1 byte, six doubles),
 *   classes: number (1 byte), each name (2 bytes length, characters), r, g, b,
 *            policy for unknown raw ids (1 byte), folds (4 bytes number; raw id 4 bytes, class 1
 * byte), number of nodes (8 bytes; 0: the map is empty), the root's NodeKind (1 byte) and value,
 * then from each inner node on, depth first: two bits of NodeKind per child (2 bytes), the leaves'
 * values, the inner children. The value of a leaf is its log-odds (float); with a class record,
 * followed by the number of named classes (1 byte), the rest's log-odds, and id (1 byte) and
 * log-odds of each. Inner nodes' values follow from their children. */
constexpr std::array<char, 8> kMagic{'S', 'E', 'M', 'O', 'C', 'T', 'R', 'E'};
constexpr std::uint32_t kVersion = 1;

enum class NodeKind : std::uint8_t { None, Leaf, LeafWithRecord, Inner };

}  // namespace semantic_octree
