#include "CoarseGround.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "ground/GroundTiles.h"

namespace semantic_planning {

using colored_graph::Rank;

namespace {

/** The tiles of a square, and a margin of tiles around it. */
std::vector<Column> tilesOf(Column low, int edge, int margin) {
  std::vector<Column> tiles;
  for (int x = low.x - margin; x < low.x + edge + margin; ++x)
    for (int y = low.y - margin; y < low.y + edge + margin; ++y) tiles.push_back({x, y});
  return tiles;
}

bool isAtBorder(Column c) {
  const int x = c.x & (kTileEdge - 1), y = c.y & (kTileEdge - 1);
  return x == 0 || y == 0 || x == kTileEdge - 1 || y == kTileEdge - 1;
}

/** f(part, its column) for the parts of other tiles that the wheels get to from a surface. */
template <class F>
void forNextTiles(const SurfaceGrid& parts, Column c, const Surface& from, int step, F f) {
  for (int y = c.y - 1; y <= c.y + 1; ++y)
    for (int x = c.x - 1; x <= c.x + 1; ++x) {
      const Column tile = tileOf({x, y});
      if (tile == tileOf(c)) continue;
      const Surface* other = surfaceNear(parts, {x, y}, from.z, step);
      if (other && other->drivable) f(CoarseGround::Id{tile, other->component});
    }
}

}  // namespace

CoarseGround::CoarseGround(const semantic_octree::SemanticOcTree& map,
                           const colored_graph::ClassOrder& order, const PlannerOptions& options)
    : m_map(map),
      m_order(order),
      m_options(options),
      m_radius(std::numeric_limits<double>::infinity()) {
  for (const Disc& disc : options.vehicle.footprint.coveringDiscs())
    m_radius = std::min(m_radius, disc.radius);
}

const CoarseGround::Part& CoarseGround::at(const Id& id) {
  makeSquare(squareOf(id.tile));
  const std::vector<Part>& parts = *m_parts.find(id.tile);
  return *std::find_if(parts.begin(), parts.end(),
                       [&](const Part& part) { return part.number == id.number; });
}

std::optional<CoarseGround::Id> CoarseGround::near(const mrpt::math::TPose2D& pose,
                                                   std::optional<double> z) {
  const Column tile = tileOf({semantic_octree::keyOf(pose.x, m_map.getResolution()),
                              semantic_octree::keyOf(pose.y, m_map.getResolution())});
  const std::vector<Column> around = tilesOf(tile, 1, 1);
  const Ground ground = groundIn(around);
  const auto place = ground.find(pose.x, pose.y, z);
  if (!place) return std::nullopt;
  std::optional<Id> nearest;
  int least = std::numeric_limits<int>::max();
  const SurfaceGrid parts = partsOf(ground, around);
  parts.forEach([&](Column t, const SurfaceTile& surfaces) {
    forSurfacesOf(t, surfaces, [&](Column c, std::size_t i) {
      const Surface& s = surfaces.surfaces[i];
      const int dx = c.x - place->column.x, dy = c.y - place->column.y;
      const int dz = int(s.z) - place->surface.z, off = dx * dx + dy * dy + dz * dz;
      if (!s.drivable || off >= least) return;
      least = off;
      nearest = Id{t, s.component};
    });
  });
  return nearest;
}

Ground CoarseGround::groundIn(const std::vector<Column>& tiles) const {
  return Ground(m_map, m_options.vehicle, m_options.ground, m_order, tiles);
}

/** The ground with only those surfaces drivable that a vehicle's middle may be over, and with
 * components by that. */
SurfaceGrid CoarseGround::partsOf(const Ground& ground, const std::vector<Column>& tiles) const {
  SurfaceGrid parts;
  for (const Column& tile : tiles) {
    const SurfaceTile* surfaces = ground.layers().surfaces().find(tile);
    if (!surfaces) continue;
    SurfaceTile& marked = parts.at(tile) = *surfaces;
    for (Surface& s : marked.surfaces)
      s.drivable =
          ground.hasClearance(s, m_radius) && m_order.rank(s.classId) != colored_graph::kForbidden;
    markComponents(tile, marked, ground.layers().shape());
  }
  return parts;
}

/** With a ring of tiles around it, for what is next to its parts: there they have the numbers that
 * the next square gives them, for it finds the same ground. */
void CoarseGround::makeSquare(Column square) {
  if (m_madeSquares.find(square)) return;
  const Column low{square.x * kSquareEdge, square.y * kSquareEdge};
  const std::vector<Column> tiles = tilesOf(low, kSquareEdge, 1);
  const Ground ground = groundIn(tiles);
  const SurfaceGrid parts = partsOf(ground, tiles);
  for (const Column& tile : tilesOf(low, kSquareEdge, 0)) addParts(tile, parts, ground.step());
  m_madeSquares.at(square) = true;
}

void CoarseGround::addParts(Column tile, const SurfaceGrid& parts, int step) {
  const SurfaceTile* surfaces = parts.find(tile);
  if (!surfaces) return;
  std::vector<Part> found;
  std::vector<std::vector<int>> columnsOfRank;
  std::vector<std::size_t> indexOf(surfaces->surfaces.size(), surfaces->surfaces.size());
  forSurfacesOf(tile, *surfaces, [&](Column c, std::size_t i) {
    const Surface& s = surfaces->surfaces[i];
    if (!s.drivable) return;
    std::size_t& index = indexOf[s.component];
    if (index == surfaces->surfaces.size()) {
      index = found.size();
      found.push_back({s.component, 0, {}});
      columnsOfRank.emplace_back(m_order.ranks());
    }
    ++columnsOfRank[index][m_order.rank(s.classId)];
    std::vector<Id>& next = found[index].next;
    if (isAtBorder(c))
      forNextTiles(parts, c, s, step, [&](const Id& id) {
        if (std::find(next.begin(), next.end(), id) == next.end()) next.push_back(id);
      });
  });
  for (std::size_t i = 0; i < found.size(); ++i) found[i].rank = rankOf(columnsOfRank[i]);
  if (!found.empty()) m_parts.at(tile) = std::move(found);
}

Rank CoarseGround::rankOf(const std::vector<int>& columnsOfRank) const {
  Rank rank = 0;
  int columns = 0;
  for (int r = 0; r < m_order.ranks() && columns < kTileEdge; ++r) {
    columns += columnsOfRank[r];
    if (columnsOfRank[r] > 0) rank = static_cast<Rank>(r);
  }
  return rank;
}

}  // namespace semantic_planning
