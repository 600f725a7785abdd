#include "OccupiedVoxels.h"

#include <semantic_types/ClassTable.h>

#include <algorithm>

namespace semantic_map_ros2 {

using octomap::OcTreeKey;
using semantic_octree::SemanticOcTree;

namespace {

/** What is the same for all voxels of a leaf. */
PackedPoint pointOf(const SemanticOcTree& map, const SemanticOcTree::Node& leaf) {
  const auto state = map.query(leaf);
  const auto color = semantic_types::colorOf(state.likeliestClass, map.classes());
  const bool hasClass = state.likeliestClass != semantic_types::kNoClass;
  PackedPoint point{};
  point.rgb = std::uint32_t(color.r) << 16 | std::uint32_t(color.g) << 8 | color.b;
  point.label = state.likeliestClass;
  point.probability = static_cast<float>(hasClass ? state.probability : state.occupancy);
  return point;
}

/** The voxels of a map between two keys. Free space is not gone through. */
struct Finder {
  const SemanticOcTree& map;
  OcTreeKey low, high;
  std::vector<PackedPoint> found;

  /** \param first, edge the node's cube */
  void visit(const SemanticOcTree::Node& node, const OcTreeKey& first, int edge) {
    for (unsigned axis = 0; axis < 3; ++axis)
      if (first[axis] > high[axis] || first[axis] + edge <= low[axis]) return;
    if (!map.isNodeOccupied(node)) return;
    if (node.isLeaf()) return add(pointOf(map, node), first, edge);
    const auto half = static_cast<octomap::key_type>(edge / 2);
    const auto along = [&](unsigned axis, int child) {
      return static_cast<octomap::key_type>(first[axis] + (child >> axis & 1) * half);
    };
    for (int i = 0; i < 8; ++i)
      if (const auto child = node.child(i))
        visit(child, {along(0, i), along(1, i), along(2, i)}, half);
  }
  /** Leaves may be larger than voxels, and than the box. */
  void add(PackedPoint point, const OcTreeKey& first, int edge) {
    const auto from = [&](unsigned a) { return std::max<int>(first[a], low[a]); };
    const auto to = [&](unsigned a) { return std::min<int>(first[a] + edge - 1, high[a]); };
    const auto centerOf = [&](int key) {
      return static_cast<float>(semantic_octree::centerOf(key, map.getResolution()));
    };
    for (int x = from(0); x <= to(0); ++x)
      for (int y = from(1); y <= to(1); ++y)
        for (int z = from(2); z <= to(2); ++z) {
          point.x = centerOf(x), point.y = centerOf(y), point.z = centerOf(z);
          found.push_back(point);
        }
  }
};

}  // namespace

const std::array<std::pair<std::string, std::uint8_t>, 6>& fieldsOfPoint() {
  constexpr std::uint8_t kUint32 = 6, kFloat32 = 7;
  static const std::array<std::pair<std::string, std::uint8_t>, 6> fields = {
      {{"x", kFloat32},
       {"y", kFloat32},
       {"z", kFloat32},
       {"rgb", kFloat32},
       {"label", kUint32},
       {"probability", kFloat32}}};
  return fields;
}

std::vector<PackedPoint> occupiedVoxels(const SemanticOcTree& map, const OcTreeKey& low,
                                        const OcTreeKey& high) {
  Finder finder{map, low, high, {}};
  if (!map.empty()) finder.visit(map.root(), {0, 0, 0}, semantic_octree::edgeAtDepth(0));
  return std::move(finder.found);
}

}  // namespace semantic_map_ros2
