#include "CandidateStore.h"

#include <algorithm>
#include <iterator>

#include "ground/SurfaceTile.h"

namespace semantic_planning {

using semantic_octree::Abstraction;
using semantic_octree::LeafCell;

CandidateStore::CandidateStore(semantic_octree::SemanticOcTree& map, const Ground& ground,
                               const RoadmapOptions& options)
    : m_map(map), m_follower(map), m_ground(ground), m_options(options) {
  if (follows()) m_follower.skipLeaves();  // begins with all
}

CandidateStore::Tile CandidateStore::make(Column tile) const {
  Tile result;
  result.made = true;
  result.lowest = 65535;
  forColumnsOf(tile, [&](Column c) {
    for (const Surface& s : m_ground.surfaces(c)) {
      if (!s.drivable) continue;
      result.lowest = std::min<int>(result.lowest, s.z);
      result.highest = std::max<int>(result.highest, s.z);
    }
  });
  if (isOfTree(m_options.kind))
    result.points = compressedPoints(tile, Abstraction(m_map), m_ground, m_options);
  else if (m_options.kind == GraphKind::Full)
    result.points = gridPoints(tile, m_ground, m_options);
  std::sort(result.points.begin(), result.points.end());
  result.points.shrink_to_fit();
  return result;
}

CandidateStore::Tile& CandidateStore::made(Column tile) {
  Tile& kept = m_tiles.at(tile);
  if (!kept.made) kept = make(tile);
  return kept;
}

void CandidateStore::addTilesOf(const semantic_octree::Cube& leaf, std::vector<Column>& tiles) {
  const int size = leaf.edge(), z = leaf.lowest.z();
  const Column low{leaf.lowest.x(), leaf.lowest.y()};
  const Column first = tileOf(low), last = tileOf({low.x + size - 1, low.y + size - 1});
  m_tiles.forEachIn(first, last, [&](Column c, const Tile& tile) {
    if (tile.made && z <= tile.highest && z + size > tile.lowest) tiles.push_back(c);
  });
}

/** Where leaves came or went, and where those that stayed may be of another class, or have become
 * occupied or free. */
std::vector<Column> CandidateStore::outdated(const semantic_octree::TileChange& touched) {
  const semantic_octree::TreeChange change = m_follower.leaves();
  std::vector<Column> tiles;
  if (touched.all || change.all) {
    m_tiles.forEach([&](Column c, const Tile& tile) {
      if (tile.made) tiles.push_back(c);
    });
    return tiles;
  }
  const Abstraction abstraction(m_map);
  for (const auto* leaves : {&change.removed, &change.added})
    for (const LeafCell& leaf : *leaves) addTilesOf(leaf, tiles);
  constexpr int kTouchedDepth = 13;  // 8 voxels
  for (const octomap::OcTreeKey& key : touched.tiles) {
    addTilesOf(semantic_octree::Cube::around({key[0], key[1], key[2]}, kTouchedDepth), tiles);
    for (const LeafCell& leaf : abstraction.leavesIn(key, key, false))
      if (leaf.depth < kTouchedDepth) addTilesOf(leaf, tiles);
  }
  return tiles;
}

CandidateStore::Change CandidateStore::update(const semantic_octree::TileChange& touched,
                                              const std::vector<Column>& changedTiles) {
  std::vector<Column> tiles;
  if (follows()) tiles = outdated(touched);
  if (isOfTree(m_options.kind) || m_options.kind == GraphKind::Full)
    tiles.insert(tiles.end(), changedTiles.begin(), changedTiles.end());
  std::sort(tiles.begin(), tiles.end());
  tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
  Change change;
  for (const Column& tile : tiles) {
    const std::vector<CandidatePoint> before = std::exchange(m_tiles.at(tile), make(tile)).points;
    const std::vector<CandidatePoint>& now = in(tile);
    std::set_difference(before.begin(), before.end(), now.begin(), now.end(),
                        std::back_inserter(change.removed));
    std::set_difference(now.begin(), now.end(), before.begin(), before.end(),
                        std::back_inserter(change.added));
  }
  return change;
}

}  // namespace semantic_planning
