#include <semantic_planning/ground/Ground.h>

#include <semantic_planning/ground/GroundOptions.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

#include "GroundTiles.h"

namespace semantic_planning {
namespace {

int voxels(double meters, double voxelSize) {
  return static_cast<int>(std::ceil(meters / voxelSize - 1e-6));
}

/** Of discs with pairs, which planners check, and of those without. */
double largestRadius(const VehicleOptions& vehicle, double voxelSize) {
  double largest = 0;
  for (const double most : {voxelSize, std::numeric_limits<double>::infinity()})
    for (const Disc& disc : vehicle.footprint.coveringDiscs(most))
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

/** Finds the tiles with anything occupied, and those within a margin of columns: holes may be
 * filled there. */
class TileSearch {
 public:
  TileSearch(const semantic_octree::SemanticOcTree& map, int margin)
      : m_map(map), m_margin(margin) {}

  std::vector<Column> find() {
    if (m_map.root()) visit(*m_map.root(), {0, 0}, 1 << m_map.getTreeDepth());
    std::vector<Column> tiles;
    m_marks.forEach([&](Column tile, char marked) {
      if (marked) tiles.push_back(tile);
    });
    return tiles;
  }

 private:
  using Node = semantic_octree::SemanticOcTree::Node;

  /** \param low its lowest keys \param size its edge */
  void visit(const Node& node, Column low, int size) {
    if (node.getLogOdds() <= 0) return;  // an inner node's is its most occupied leaf's
    if (node.isLeaf() || size == kTileEdge) return mark(low, size);
    const int half = size / 2;
    for (int i = 0; i < 8; ++i)
      if (const Node child = node.child(i))
        visit(child, {low.x + (i & 1 ? half : 0), low.y + (i & 2 ? half : 0)}, half);
  }

  void mark(Column low, int size) {
    const Column first = tileOf({low.x - m_margin, low.y - m_margin});
    const Column last = tileOf({low.x + size - 1 + m_margin, low.y + size - 1 + m_margin});
    if (std::max(last.x - first.x, last.y - first.y) > 1000)
      throw std::invalid_argument("an occupied cell of the map is too large to be ground");
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x) m_marks.at({x, y}) = true;
  }

  const semantic_octree::SemanticOcTree& m_map;
  const int m_margin;
  ColumnGrid<char> m_marks;
};

}  // namespace

GroundShape::GroundShape(const VehicleOptions& vehicle, const GroundOptions& options,
                         const colored_graph::ClassOrder& order, double voxelSize)
    : height(voxels(vehicle.height, voxelSize)),
      step(std::max(1, static_cast<int>(vehicle.stepHeight / voxelSize + 1e-6))),
      fillGap(options.fillGap / voxelSize + 1e-6),
      widestGap(std::max(options.fillGap, options.unknownGap) / voxelSize + 1e-6),
      rise(std::tan(vehicle.maxSlope * M_PI / 180)),
      baseline(std::max(2, static_cast<int>(std::lround(0.6 / voxelSize)))),
      largestClearance(voxels(largestRadius(vehicle, voxelSize) + vehicle.clearance, voxelSize) +
                       1),
      ranks(order.classes()),
      keepOff(order.classes()) {
  for (int id = 0; id < order.classes(); ++id) {
    ranks[id] = order.rank(static_cast<colored_graph::GraphClass>(id));
    keepOff[id] = options.keepOff && ranks[id] == colored_graph::kForbidden;
  }
}

Ground::Ground(const semantic_octree::SemanticOcTree& map, const VehicleOptions& vehicle,
               const GroundOptions& options, const colored_graph::ClassOrder& order)
    : m_map(map),
      m_voxelSize(map.getResolution()),
      m_clearance(vehicle.clearance),
      m_perMeter(1 / m_voxelSize) {
  vehicle.validate();
  options.validate();
  checkOrder(map, order);
  const GroundShape shape(vehicle, options, order, m_voxelSize);
  m_step = shape.step;
  m_largestClearance = shape.largestClearance;
  m_tiles = std::make_unique<GroundTiles>(map, shape);
  m_tiles->read(TileSearch(map, std::max(kTileEdge, reachOfGapFills(shape))).find());
}

Ground::Ground(const Ground& of, std::unique_ptr<GroundTiles> tiles)
    : m_tiles(std::move(tiles)),
      m_map(of.m_map),
      m_voxelSize(of.m_voxelSize),
      m_clearance(of.m_clearance),
      m_perMeter(of.m_perMeter),
      m_step(of.m_step),
      m_largestClearance(of.m_largestClearance) {}

Ground Ground::frozen() const { return Ground(*this, m_tiles->frozen()); }

Ground::~Ground() = default;
Ground::Ground(Ground&&) noexcept = default;

std::vector<Column> Ground::update(const semantic_octree::TileChange& change) {
  std::vector<Column> tiles = change.all ? m_tiles->known() : std::vector<Column>();
  for (const octomap::OcTreeKey& key : change.tiles) tiles.push_back(tileOf({key[0], key[1]}));
  sortOut(tiles);
  return m_tiles->update(tiles);
}

std::vector<Column> Ground::assume(const std::vector<GroundPoint>& points) {
  if (m_map.isReadOnly()) return {};
  std::map<Column, std::array<std::optional<Surface>, kTileColumns>> tiles;
  for (const GroundPoint& p : points) tiles[tileOf(p.column)][indexInTile(p.column)] = p.surface;
  SurfaceGrid ground;
  for (const auto& [tile, columns] : tiles) {
    SurfaceTile& surfaces = ground.at(tile);
    for (int column = 0; column < kTileColumns; ++column) {
      if (columns[column]) surfaces.surfaces.push_back(*columns[column]);
      surfaces.first[column + 1] = static_cast<std::uint16_t>(surfaces.surfaces.size());
    }
  }
  return m_tiles->assume(std::move(ground));
}

SurfaceRange Ground::surfaces(Column c) const { return surfacesAt(m_tiles->surfaces(), c); }

const Surface* Ground::near(Column c, int z, int tolerance) const {
  return surfaceNear(m_tiles->surfaces(), c, z, tolerance);
}

bool Ground::isOccupied(Column c, int low, int high) const {
  return m_tiles->isOccupied(c, low, high);
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
  const GroundComponents& components = m_tiles->components();
  return components.componentOf(a.column, a.surface) == components.componentOf(b.column, b.surface);
}

std::vector<Column> Ground::tiles() const {
  std::vector<Column> tiles;
  m_tiles->surfaces().forEach([&](Column tile, const SurfaceTile& t) {
    if (!t.surfaces.empty()) tiles.push_back(tile);
  });
  return tiles;
}

void GroundOptions::describe(strict_files::OptionList& list) {
  const strict_files::Range gap = strict_files::between(0, 20);
  list.add("fill_gap", fillGap, "m", gap,
           "widest hole in the ground that is filled, with the class of its border");
  list.add("keep_off", keepOff, "",
           "keep the whole footprint off forbidden classes; otherwise only the wheels");
}

void GroundOptions::validate() const { strict_files::checkOptions(*this, "GroundOptions"); }

}  // namespace semantic_planning
