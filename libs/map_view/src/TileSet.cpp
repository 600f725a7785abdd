#include <map_view/TileSet.h>

#include <algorithm>
#include <array>
#include <map>

namespace map_view {

using semantic_octree::kKeyOfOrigin;
using semantic_octree::SemanticOcTreeNode;

namespace {

class Selection {
 public:
  Selection(const SemanticOcTree& map, const View& view, const CellLook& look)
      : m_voxelSize(map.getResolution()),
        m_view(view),
        m_position(view.camera.position()),
        m_focalLength(view.camera.focalLength(view.height)),
        m_style(look.style()),
        m_bounds(look.bounds()) {}

  void visit(const SemanticOcTreeNode& node, const Tile& tile) {
    if (!mayShow(node, tile)) return;
    const double edge = tile.edge() * m_voxelSize;
    const Eigen::Vector3d low = (tile.lowest - kKeyOfOrigin).cast<double>().matrix() * m_voxelSize;
    const Eigen::Vector3d center = low.array() + edge / 2;
    if (!m_view.camera.maySee(center, edge * std::sqrt(0.75), m_view.width, m_view.height)) return;
    const double distance = distanceTo(center, edge / 2);
    if (tile.depth == kFinestTiles || (node && node.isLeaf()) || isFineEnough(edge, distance))
      m_found.emplace_back(distance, tile);
    else
      for (int i = 0; i < 8; ++i)
        visit(node ? node.child(i) : SemanticOcTreeNode(), Tile{tile.child(i)});
  }

  std::vector<Tile> nearestFirst() {
    std::sort(m_found.begin(), m_found.end());
    std::vector<Tile> tiles;
    for (const auto& [distance, tile] : m_found) tiles.push_back(tile);
    return tiles;
  }

 private:
  bool mayShow(const SemanticOcTreeNode& node, const Tile& tile) const {
    if (node && (m_style.freeSpace || node.getLogOdds() > 0)) return true;
    return m_style.unknownSpace && m_bounds.meets(tile);
  }
  double distanceTo(const Eigen::Vector3d& center, double half) const {
    return ((m_position - center).array().abs() - half).max(0).matrix().norm();
  }
  bool isFineEnough(double edge, double distance) const {
    return edge / kCellsPerTile * m_focalLength <= m_view.pixelsPerCell * distance;
  }

  double m_voxelSize;
  const View& m_view;
  Eigen::Vector3d m_position;
  double m_focalLength;
  const ViewStyle& m_style;
  KeyBox m_bounds;
  std::vector<std::pair<double, Tile>> m_found;
};

}  // namespace

std::vector<Tile> tilesSeen(const SemanticOcTree& map, const View& view, const CellLook& look) {
  if (map.empty()) return {};
  Selection selection(map, view, look);
  selection.visit(map.root(), Tile());
  return selection.nearestFirst();
}

/** There may be a million boxes: those in one cube of the size of the finest tiles become one. */
void FreshTiles::remove(const std::vector<KeyBox>& boxes) {
  std::map<std::array<int, 3>, KeyBox> cubes;
  const int edge = semantic_octree::edgeAtDepth(kFinestTiles);
  for (const KeyBox& box : boxes) {
    const Eigen::Array3i cube = box.low / edge;
    const auto [at, isNew] = cubes.emplace(std::array<int, 3>{cube.x(), cube.y(), cube.z()}, box);
    if (isNew) continue;
    at->second.low = at->second.low.min(box.low);
    at->second.high = at->second.high.max(box.high);
  }
  const auto shows = [&](const Tile& tile) {
    const int border = tile.cellEdge();
    return std::any_of(cubes.begin(), cubes.end(), [&](const auto& entry) {
      const KeyBox& box = entry.second;
      return KeyBox{box.low - border, box.high + border}.meets(tile);
    });
  };
  for (auto tile = m_tiles.begin(); tile != m_tiles.end();)
    tile = shows(*tile) ? m_tiles.erase(tile) : std::next(tile);
}

}  // namespace map_view
