#include <semantic_planning/planner/Corridor.h>

#include <semantic_planning/planner/SemanticPlanner.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <map>
#include <optional>
#include <queue>
#include <vector>

#include "PlannerCore.h"
#include "RelaxedField.h"
#include "ground/GroundTiles.h"
#include "ground/SurfaceTile.h"

namespace semantic_planning {

using colored_graph::Rank;
using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

namespace {

using Cost = RelaxedField::Cost;

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

/** A part of a tile's ground: where a vehicle's middle gets within the tile, with the clearance
 * that its footprint's smallest disc needs. */
using Id = std::pair<Column, std::uint16_t>;  ///< the tile, and which of its parts

struct Part {
  /** The best for which, together with better ones, there are as many columns as from one side of
   * the tile to the other. */
  Rank rank = 0;
  std::vector<Id> next;  ///< in other tiles, one step of the wheels away
  Cost cost = RelaxedField::kUnreached;
  Id before;  ///< the start's is itself
};

/** A* from part to part. Parts are found square by square when they are asked for, and kept; the
 * ground is not. */
class CorridorSearch {
 public:
  CorridorSearch(const semantic_octree::SemanticOcTree& map, const colored_graph::ClassOrder& order,
                 const PlannerOptions& options)
      : m_map(map),
        m_order(order),
        m_options(options),
        m_weights(weightsOfRanks(order)),
        m_radius(std::numeric_limits<double>::infinity()) {
    for (const Disc& disc : options.vehicle.footprint.coveringDiscs())
      m_radius = std::min(m_radius, disc.radius);
  }

  /** The nearest part to where the ground is, at most about a tile off. */
  std::optional<Id> near(const TPose2D& pose, std::optional<double> z) const {
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
        nearest = Id(t, s.component);
      });
    });
    return nearest;
  }

  /** The tiles on the way; none: there is no way. */
  std::vector<Column> run(const Id& start, const Id& goal) {
    const auto estimate = [&](const Id& id, Cost cost) {
      return cost + kWeightOfLength * stepsBetween(id.first, goal.first);
    };
    const auto reach = [&](const Id& id, Cost cost, const Id& before) {
      Part& part = at(id);
      if (cost >= part.cost) return;
      part.cost = cost;
      part.before = before;
      m_queue.push({estimate(id, cost), id});
    };
    reach(start, 0, start);
    while (!m_queue.empty()) {
      const auto [least, id] = m_queue.top();
      m_queue.pop();
      if (id == goal) return tilesTo(goal);
      const Part& part = at(id);
      if (least != estimate(id, part.cost)) continue;  // there was a better way to it
      for (const Id& next : part.next)
        reach(next, part.cost + stepsBetween(id.first, next.first) * m_weights[at(next).rank], id);
    }
    return {};
  }

 private:
  using Entry = std::pair<Cost, Id>;

  Part& at(const Id& id) {
    makeSquare(squareOf(id.first));
    return m_parts.at(id);
  }

  Ground groundIn(const std::vector<Column>& tiles) const {
    return Ground(m_map, m_options.vehicle, m_options.ground, m_order, tiles);
  }

  /** The ground with only those surfaces drivable that a vehicle's middle may be over, and with
   * components by that. */
  SurfaceGrid partsOf(const Ground& ground, const std::vector<Column>& tiles) const {
    SurfaceGrid parts;
    for (const Column& tile : tiles) {
      const SurfaceTile* surfaces = ground.layers().surfaces().find(tile);
      if (!surfaces) continue;
      SurfaceTile& marked = parts.at(tile) = *surfaces;
      for (Surface& s : marked.surfaces)
        s.drivable = ground.hasClearance(s, m_radius) &&
                     m_order.rank(s.classId) != colored_graph::kForbidden;
      markComponents(tile, marked, ground.layers().shape());
    }
    return parts;
  }

  /** With a ring of tiles around it, for what is next to its parts. The next square finds the same
   * ground there, and so the same numbers. */
  void makeSquare(Column square) {
    if (m_madeSquares.find(square)) return;
    const Column low{square.x * kSquareEdge, square.y * kSquareEdge};
    const std::vector<Column> tiles = tilesOf(low, kSquareEdge, 1);
    const Ground ground = groundIn(tiles);
    const SurfaceGrid parts = partsOf(ground, tiles);
    for (const Column& tile : tilesOf(low, kSquareEdge, 0)) addParts(tile, parts, ground.step());
    m_madeSquares.at(square) = true;
  }

  void addParts(Column tile, const SurfaceGrid& parts, int step) {
    const SurfaceTile* surfaces = parts.find(tile);
    if (!surfaces) return;
    std::map<Id, std::vector<int>> columnsOfRank;
    forSurfacesOf(tile, *surfaces, [&](Column c, std::size_t i) {
      const Surface& s = surfaces->surfaces[i];
      if (!s.drivable) return;
      const Id id(tile, s.component);
      ++columnsOfRank.try_emplace(id, m_order.ranks()).first->second[m_order.rank(s.classId)];
      if (isAtBorder(c)) addNext(parts, c, s, step, m_parts[id].next);
    });
    for (const auto& [id, columns] : columnsOfRank) m_parts[id].rank = rankOf(columns);
  }

  /** The parts of other tiles that the wheels get to from a surface. */
  static void addNext(const SurfaceGrid& parts, Column c, const Surface& from, int step,
                      std::vector<Id>& next) {
    for (int y = c.y - 1; y <= c.y + 1; ++y)
      for (int x = c.x - 1; x <= c.x + 1; ++x) {
        const Column tile = tileOf({x, y});
        if (tile == tileOf(c)) continue;
        const Surface* other = surfaceNear(parts, {x, y}, from.z, step);
        if (!other || !other->drivable) continue;
        const Id id(tile, other->component);
        if (std::find(next.begin(), next.end(), id) == next.end()) next.push_back(id);
      }
  }

  Rank rankOf(const std::vector<int>& columnsOfRank) const {
    Rank rank = 0;
    int columns = 0;
    for (int r = 0; r < m_order.ranks() && columns < kTileEdge; ++r) {
      columns += columnsOfRank[r];
      if (columnsOfRank[r] > 0) rank = static_cast<Rank>(r);
    }
    return rank;
  }

  std::vector<Column> tilesTo(Id id) const {
    std::vector<Column> tiles{id.first};
    for (Id before = m_parts.at(id).before; before != id; before = m_parts.at(id).before) {
      id = before;
      tiles.push_back(id.first);
    }
    std::reverse(tiles.begin(), tiles.end());
    return tiles;
  }

  const semantic_octree::SemanticOcTree& m_map;
  const colored_graph::ClassOrder& m_order;
  const PlannerOptions& m_options;
  const std::vector<Cost> m_weights;  ///< of a length, by rank
  double m_radius;                    ///< of the smallest disc, meters
  std::map<Id, Part> m_parts;
  ColumnGrid<char> m_madeSquares;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> m_queue;
};

}  // namespace

std::vector<Column> Corridor::tiles(double voxelSize) const {
  const double edge = kTileEdge * voxelSize;
  const auto tileAt = [&](double x, double y) {
    return tileOf({semantic_octree::keyOf(x, voxelSize), semantic_octree::keyOf(y, voxelSize)});
  };
  std::vector<Column> tiles;
  for (const TPoint2D& p : way) {
    const Column low = tileAt(p.x - width, p.y - width), high = tileAt(p.x + width, p.y + width);
    for (int x = low.x; x <= high.x; ++x)
      for (int y = low.y; y <= high.y; ++y) {
        const Column first = firstColumnOf({x, y});
        const double dx = semantic_octree::lowerBorderOf(first.x, voxelSize) + edge / 2 - p.x;
        const double dy = semantic_octree::lowerBorderOf(first.y, voxelSize) + edge / 2 - p.y;
        if (std::hypot(dx, dy) <= width + edge) tiles.push_back({x, y});
      }
  }
  sortOut(tiles);
  return tiles;
}

bool Corridor::mayNeed(const TPoint2D& low, const TPoint2D& high) const {
  const auto distance = [](double at, double from, double to) {
    return std::max({0.0, from - at, at - to});
  };
  return std::any_of(way.begin(), way.end(), [&](const TPoint2D& p) {
    return std::hypot(distance(p.x, low.x, high.x), distance(p.y, low.y, high.y)) <= width + reach;
  });
}

Corridor findCorridor(const semantic_octree::SemanticOcTree& map,
                      const colored_graph::ClassOrder& order, const PlannerOptions& options,
                      const CorridorTask& task) {
  options.validate();
  PlannerCore::checkFinite("start", {task.start, task.startZ});
  PlannerCore::checkFinite("goal", {task.goal, task.goalZ});
  const double voxel = map.getResolution(), edge = kTileEdge * voxel;
  const GroundShape shape(options.vehicle, options.ground, order, voxel);
  Corridor corridor{
      {{task.start.x, task.start.y}}, task.width, voxel * reachOfGround(shape) + 4 * edge};
  CorridorSearch search(map, order, options);
  const auto start = search.near(task.start, task.startZ),
             goal = search.near(task.goal, task.goalZ);
  std::vector<Column> tiles;
  if (start && goal) tiles = search.run(*start, *goal);
  for (const Column& tile : tiles) {
    const Column first = firstColumnOf(tile);
    corridor.way.emplace_back(semantic_octree::lowerBorderOf(first.x, voxel) + edge / 2,
                              semantic_octree::lowerBorderOf(first.y, voxel) + edge / 2);
  }
  corridor.way.emplace_back(task.goal.x, task.goal.y);
  return corridor;
}

}  // namespace semantic_planning
