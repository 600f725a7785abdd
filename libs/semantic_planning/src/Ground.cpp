#include <semantic_planning/Ground.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "GroundTiles.h"

namespace semantic_planning {
namespace {

int voxels(double meters, double voxelSize) {
  return static_cast<int>(std::ceil(meters / voxelSize - 1e-6));
}

double largestRadius(const VehicleOptions& vehicle) {
  double largest = 0;
  for (const Disc& disc : coveringDiscs(vehicle.footprint))
    largest = std::max(largest, disc.radius);
  return largest;
}

void checkOrder(const semantic_octree::SemanticOcTree& map,
                const colored_graph::ClassOrder& order) {
  if (order.classes() != map.numClasses() + 1)
    throw std::invalid_argument("order of " + std::to_string(order.classes()) +
                                " classes, but the map has " + std::to_string(map.numClasses()) +
                                " and unknown ground counts as one");
}

/** Marks the tiles that a cube of voxels touches. */
void mark(Column low, int edge, TileGrid<char>& marks) {
  const Column first = tileOf(low), last = tileOf({low.x + edge - 1, low.y + edge - 1});
  if (std::max(last.x - first.x, last.y - first.y) > 1000)
    throw std::invalid_argument("an occupied cell of the map is too large to be ground");
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x) marks.at({x, y}) = true;
}

/** The tiles with anything occupied, and those next to them: holes may be bridged there. */
std::vector<Column> tilesOf(const semantic_octree::SemanticOcTree& map) {
  TileGrid<char> marks;
  for (auto it = map.begin_leafs(), end = map.end_leafs(); it != end; ++it) {
    if (it->getLogOdds() <= 0) continue;
    const int edge = 1 << (map.getTreeDepth() - it.getDepth());
    const auto low = it.getIndexKey();
    mark({low[0] - kTileEdge, low[1] - kTileEdge}, edge + 2 * kTileEdge, marks);
  }
  std::vector<Column> tiles;
  marks.forEach([&](Column tile, char marked) {
    if (marked) tiles.push_back(tile);
  });
  return tiles;
}

}  // namespace

GroundShape::GroundShape(const VehicleOptions& vehicle, const GroundOptions& options,
                         const colored_graph::ClassOrder& order, double voxelSize)
    : height(voxels(vehicle.height, voxelSize)),
      step(std::max(1, static_cast<int>(vehicle.stepHeight / voxelSize + 1e-6))),
      bridgeGap(options.bridgeGap / voxelSize + 1e-6),
      widestGap(std::max(options.bridgeGap, options.unknownGap) / voxelSize + 1e-6),
      rise(std::tan(vehicle.maxSlope * M_PI / 180)),
      baseline(std::max(2, static_cast<int>(std::lround(0.6 / voxelSize)))),
      farthestRoom(voxels(largestRadius(vehicle) + vehicle.clearance, voxelSize) + 1),
      keepOff(order.classes()) {
  for (int id = 0; id < order.classes(); ++id)
    keepOff[id] = options.keepFootprintOffForbidden &&
                  order.rank(static_cast<colored_graph::ClassId>(id)) == colored_graph::kForbidden;
}

Ground::Ground(const semantic_octree::SemanticOcTree& map, const VehicleOptions& vehicle,
               const GroundOptions& options, const colored_graph::ClassOrder& order)
    : m_map(map), m_voxelSize(map.getResolution()), m_clearance(vehicle.clearance) {
  vehicle.validate();
  options.validate();
  checkOrder(map, order);
  const GroundShape shape(vehicle, options, order, m_voxelSize);
  m_step = shape.step;
  m_farthestRoom = shape.farthestRoom;
  m_tiles = std::make_unique<GroundTiles>(map, shape);
  m_tiles->update(tilesOf(map));
}

Ground::~Ground() = default;
Ground::Ground(Ground&&) noexcept = default;

std::vector<Column> Ground::update(const std::vector<octomap::OcTreeKey>& touchedTiles) {
  std::vector<Column> tiles;
  for (const octomap::OcTreeKey& key : touchedTiles) tiles.push_back(tileOf({key[0], key[1]}));
  std::sort(tiles.begin(), tiles.end());
  tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
  return m_tiles->update(tiles);
}

Column Ground::columnAt(double x, double y) const {
  return {static_cast<int>(std::floor(x / m_voxelSize)) + 32768,
          static_cast<int>(std::floor(y / m_voxelSize)) + 32768};
}

SurfaceRange Ground::surfaces(Column c) const { return surfacesAt(m_tiles->surfaces(), c); }

const Surface* Ground::near(Column c, int z, int tolerance) const {
  return surfaceNear(m_tiles->surfaces(), c, z, tolerance);
}

std::optional<GroundPoint> Ground::find(double x, double y, std::optional<double> nearZ) const {
  const Column c = columnAt(x, y);
  const Surface* best = nullptr;
  for (const Surface& s : surfaces(c)) {
    if (!s.drivable) continue;
    const auto off = [&](const Surface& t) { return std::abs(centerOf(t.z) - *nearZ); };
    if (!best || (nearZ && off(s) < off(*best))) best = &s;
  }
  if (!best) return std::nullopt;
  return GroundPoint{c, *best};
}

bool Ground::connected(const GroundPoint& a, const GroundPoint& b) const {
  const GroundParts& parts = m_tiles->parts();
  return parts.partOf(a.column, a.surface) == parts.partOf(b.column, b.surface);
}

std::vector<Column> Ground::tiles() const {
  std::vector<Column> tiles;
  m_tiles->surfaces().forEach([&](Column tile, const SurfaceTile& t) {
    if (!t.surfaces.empty()) tiles.push_back(tile);
  });
  return tiles;
}

}  // namespace semantic_planning
