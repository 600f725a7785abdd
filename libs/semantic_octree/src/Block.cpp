#include <semantic_octree/store/NodeStore.h>

#include <algorithm>

namespace semantic_octree {

Units Block::highestValue() const {
  Units highest = kUnknown;  // not std::max_element(), which looks at one value after the other
  for (const Units value : values) highest = std::max(highest, value);
  return highest;
}

Block::Count Block::count() const {
  constexpr VoxelBits kFirsts = 0x0101010101010101;
  VoxelBits any = known | known >> 4;
  any |= any >> 2;
  any = (any | any >> 1) & kFirsts;  // one bit per known octant
  // The leaves' bits, one in each octant: the eighth of the copies of all eight.
  const VoxelBits leaves = (leafOctants * kFirsts & 0x8040201008040201) + 0x7f7f7f7f7f7f7f7f;
  const VoxelBits leaf = ((leaves | (leafOctants * kFirsts & 0x8040201008040201)) >> 7) & kFirsts;
  return {countOf(any) + countOf(known & ~(leaf * 0xff)), countOf(any & ~leaf)};
}

void BlockContent::setVoxel(int voxel, Units value, const ClassRecord* record) {
  values[voxel] = value;
  known |= VoxelBits(1) << voxel;
  if (!record) return;
  recorded |= VoxelBits(1) << voxel;
  records[voxel] = *record;
}

void BlockContent::setLeafOctant(int octant, Units value, const ClassRecord* record) {
  setVoxel(8 * octant, value, record);
  std::fill_n(values + 8 * octant, 8, value);
  known |= VoxelBits(0xff) << 8 * octant;
  leafOctants |= static_cast<std::uint8_t>(1u << octant);
}

void BlockContent::mergeOctant(int octant) {
  const int first = 8 * octant;
  const auto bitsOf = [first](VoxelBits bits) { return bits >> first & 0xff; };
  if (bitsOf(known) != 0xff || (bitsOf(recorded) != 0 && bitsOf(recorded) != 0xff)) return;
  for (int i = first + 1; i < first + 8; ++i)
    if (values[i] != values[first] || (bitsOf(recorded) && records[i] != records[first])) return;
  leafOctants |= static_cast<std::uint8_t>(1u << octant);
  recorded &= ~(VoxelBits(0xfe) << first);
}

}  // namespace semantic_octree
