#include "MapCells.h"

#include <algorithm>
#include <array>
#include <unordered_map>

namespace map_pictures {

using semantic_octree::SemanticOcTree;

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
  forEachNode(tree, [&](const SemanticOcTree::Node& node, const Cube& cube) {
    if (!filter.takes(node, cube)) return false;
    if (!node.isLeaf() && cube.depth < static_cast<int>(map.depth)) return true;
    MapCell cell = cellOf(cube, tree.getResolution());
    cell.id = tree.query(node).likeliestClass;
    map.cells.push_back(cell);
    return false;
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

namespace {

/** Room below a ceiling, m. */
constexpr float kRoom = 1.2f;
/** Ceilings are that flat: most of it within these, m. */
constexpr float kFlat = 0.4f;

/** The two uppermost surfaces of one column, m: centers of their highest cells. */
struct Column {
  float top = -std::numeric_limits<float>::infinity(), next = top;

  void add(float z) {
    if (z > top) std::swap(z, top);
    if (top - z > kRoom) next = std::max(next, z);
  }
};

/** Heights of what hangs over something with room between. */
std::vector<float> hangingSurfaces(const std::vector<MapCell>& cells, std::size_t& columns) {
  std::unordered_map<std::uint32_t, Column> byPlace;
  for (const MapCell& cell : cells)
    byPlace[std::uint32_t(cell.key[0]) << 16 | cell.key[1]].add(cell.center.z());
  columns = byPlace.size();
  std::vector<float> heights;
  for (const auto& [place, column] : byPlace)
    if (column.next > -std::numeric_limits<float>::infinity()) heights.push_back(column.top);
  return heights;
}

/** The lowest height at which a flat surface of a room's size begins; heights are sorted. */
float lowestFlatSurface(const std::vector<float>& heights, std::size_t size) {
  for (std::size_t i = 0; i + size <= heights.size(); ++i)
    if (heights[i + size - 1] - heights[i] < kFlat / 2) return heights[i];
  return heights.front();
}

}  // namespace

double heightUnderCeiling(const std::vector<MapCell>& cells) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::size_t columns = 0;
  std::vector<float> heights = hangingSurfaces(cells, columns);
  if (columns == 0 || heights.size() * 2 < columns) return kNone;
  std::sort(heights.begin(), heights.end());
  const float lower = heights[heights.size() / 5], upper = heights[heights.size() * 4 / 5];
  if (upper - lower > kFlat) return kNone;
  return lowestFlatSurface(heights, std::max<std::size_t>(1, columns / 20)) - kFlat / 2;
}

}  // namespace map_pictures
