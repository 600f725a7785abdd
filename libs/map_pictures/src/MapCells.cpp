#include "MapCells.h"

#include <semantic_octree/SmoothedView.h>

#include <algorithm>

namespace map_pictures {

using semantic_octree::CellState;
using semantic_octree::SemanticOcTree;
using semantic_octree::SmoothedView;

namespace {

/** More than that are smaller than a pixel. */
constexpr std::size_t kMostCells = 600'000;

/** Calls action(iterator) until it returns false. \return whether it never did */
template <class Action>
bool forEachOccupied(const SemanticOcTree& tree, unsigned depth, double minOccupancy,
                     Action action) {
  for (auto it = tree.begin_leafs(static_cast<unsigned char>(depth)), end = tree.end_leafs();
       it != end; ++it)
    if (it->getOccupancy() > minOccupancy && !action(it)) return false;
  return true;
}

unsigned depthToDraw(const SemanticOcTree& tree, double minOccupancy) {
  for (unsigned depth = tree.getTreeDepth(); depth > 1; --depth) {
    std::size_t count = 0;
    if (forEachOccupied(tree, depth, minOccupancy,
                        [&count](const auto&) { return ++count <= kMostCells; }))
      return depth;
  }
  return 1;
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

MapCells collectCells(const SemanticOcTree& tree, const PictureStyle& style) {
  MapCells map;
  map.minOccupancy = style.minOccupancy;
  map.depth = depthToDraw(tree, style.minOccupancy);
  const bool smooth = style.neighborWeight > 0 && map.depth == tree.getTreeDepth();
  const SmoothedView view(tree, {style.neighborWeight});
  forEachOccupied(tree, map.depth, style.minOccupancy, [&](const auto& it) {
    const CellState state = smooth ? view.query(it.getKey()) : tree.query(*it);
    map.cells.push_back({it.getKey(), it.getDepth(),
                         Eigen::Vector3d(it.getX(), it.getY(), it.getZ()).cast<float>(),
                         float(it.getSize()), state.likeliestClass});
    return true;
  });
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
