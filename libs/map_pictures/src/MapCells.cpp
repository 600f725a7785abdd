#include "MapCells.h"

#include <map_operations/SmoothedView.h>

#include <algorithm>
#include <array>

#include "NodeWalk.h"

namespace map_pictures {

using semantic_octree::SemanticOcTree;
using semantic_octree::SmoothedView;

namespace {

/** More than that are smaller than a pixel. */
constexpr std::size_t kMostCells = 600'000;

struct Drawn {
  unsigned depth;
  std::size_t cells;  ///< at most
};

/** Which nodes are worth a look. */
class Filter {
 public:
  Filter(const SemanticOcTree& tree, const std::optional<Eigen::AlignedBox2d>& part)
      : m_voxelSize(tree.getResolution()), m_part(part) {}

  bool takes(const SemanticOcTree::Node& node, const Cube& cube) const {
    return node.getOccupancy() > MapCells::kOccupied && (!m_part || isInPart(cube));
  }

 private:
  bool isInPart(const Cube& cube) const {
    const Eigen::Vector2d center = cube.center(m_voxelSize).head<2>();
    const Eigen::Vector2d nearest = center.cwiseMax(m_part->min()).cwiseMin(m_part->max());
    return (nearest - center).cwiseAbs().maxCoeff() < m_voxelSize * cube.edge() / 2;
  }

  double m_voxelSize;
  std::optional<Eigen::AlignedBox2d> m_part;
};

/** The largest depth at which there are not too many cells. Of a map in tiles, each tile comes in
 * once at most. */
Drawn depthToDraw(const SemanticOcTree& tree, const Filter& filter) {
  std::array<std::size_t, semantic_octree::kTreeDepth + 1> cells{};  // at each depth
  int deepest = semantic_octree::kTreeDepth;
  forEachNode(tree, [&](const SemanticOcTree::Node& node, const Cube& cube) {
    if (!filter.takes(node, cube)) return false;
    const int last = node.isLeaf() ? deepest : cube.depth;
    for (int depth = cube.depth; depth <= last; ++depth) ++cells[depth];
    while (deepest > 1 && cells[deepest] > kMostCells) --deepest;
    return cube.depth < deepest;
  });
  return {static_cast<unsigned>(deepest), cells[deepest]};
}

MapCell cellOf(const Cube& cube, double voxelSize) {
  const Eigen::Array3i middle = cube.lowest + cube.edge() / 2;
  return {semantic_octree::octomapKey(middle.x(), middle.y(), middle.z()),
          static_cast<unsigned>(cube.depth), cube.center(voxelSize).cast<float>(),
          float(voxelSize * cube.edge()), semantic_types::kNoClass};
}

void cutOff(MapCells& map, const PictureStyle& style) {
  map.maxHeight = style.maxHeight ? *style.maxHeight : heightUnderCeiling(map.cells);
  if (style.maxAboveGround) {
    map.maxAboveGround = *style.maxAboveGround;
    for (const MapCell& cell : map.cells) map.ground.add(cell.center, cell.size);
  }
  const auto above = [&map](const MapCell& cell) { return map.isCutOff(cell.center); };
  map.cells.erase(std::remove_if(map.cells.begin(), map.cells.end(), above), map.cells.end());
}

}  // namespace

std::vector<std::size_t> MapCells::countClasses(int numClasses) const {
  std::vector<std::size_t> count(numClasses + 1, 0);
  for (const MapCell& cell : cells) ++count[cell.id];
  return count;
}

MapCells collectCells(const SemanticOcTree& tree, const PictureStyle& style,
                      const std::optional<Eigen::AlignedBox2d>& part) {
  MapCells map;
  const Filter filter(tree, part);
  const Drawn drawn = depthToDraw(tree, filter);
  map.depth = drawn.depth;
  map.cells.reserve(drawn.cells);
  const bool smooth = style.neighborWeight > 0 && map.depth == tree.getTreeDepth();
  const SmoothedView view(tree, {style.neighborWeight});
  forEachNode(tree, [&](const SemanticOcTree::Node& node, const Cube& cube) {
    if (!filter.takes(node, cube)) return false;
    if (!node.isLeaf() && cube.depth < static_cast<int>(map.depth)) return true;
    MapCell cell = cellOf(cube, tree.getResolution());
    if (!smooth) cell.id = tree.query(node).likeliestClass;
    map.cells.push_back(cell);
    return false;
  });
  if (smooth)  // later, for nodes may be gone when neighbors in other tiles come in
    for (MapCell& cell : map.cells) cell.id = view.query(cell.key).likeliestClass;
  cutOff(map, style);
  return map;
}

Extent extentOf(const std::vector<MapCell>& cells) {
  constexpr double kFar = 0.002;
  Extent extent;
  std::vector<float> values(cells.size());
  for (int axis = 0; axis < 3; ++axis) {
    const auto edges = [&](float sign) {
      for (std::size_t i = 0; i < cells.size(); ++i)
        values[i] = cells[i].center[axis] + sign * cells[i].size / 2;
    };
    edges(-1), extent.low[axis] = quantile(values, kFar);
    edges(+1), extent.high[axis] = quantile(values, 1 - kFar);
  }
  return extent;
}

}  // namespace map_pictures
