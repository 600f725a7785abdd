#pragma once
#include <semantic_planning/ground/Ground.h>
#include <semantic_planning/planner/Slices.h>
#include <semantic_planning/roadmap/CollisionChecker.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "ClassPrices.h"
#include "ground/GroundTiles.h"

namespace semantic_planning {

/** Steps to neighbors on a grid, each turned by 45 degrees from the one before, and their lengths
 * in fifths of its spacing. */
constexpr std::array<Column, 8> kSteps = {
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
constexpr std::int64_t kStraightStep = 5, kDiagonalStep = 7;
inline Column operator+(Column a, Column b) { return {a.x + b.x, a.y + b.y}; }

/** Least length of steps between two columns. */
inline std::int64_t stepsBetween(Column a, Column b) {
  const std::int64_t dx = std::abs(a.x - b.x), dy = std::abs(a.y - b.y);
  return kStraightStep * std::max(dx, dy) + (kDiagonalStep - kStraightStep) * std::min(dx, dy);
}

/** What a search from one drivable surface of a region to the next knows about each of them. Only
 * tiles that it gets to take memory: a way along a road is a small part of its region. */
class RelaxedField {
 public:
  using Cost = std::int64_t;
  static constexpr Cost kUnreached = std::numeric_limits<Cost>::max();

  /** Names a surface. Sorted by tile, column, and height. */
  struct Cell {
    std::int32_t tile = SurfaceGrid::kNoTile;
    std::uint16_t index = 0;  ///< in the tile
    std::uint8_t column = 0;  ///< of the tile, which the index says as well, but not as soon
    explicit operator bool() const { return tile != SurfaceGrid::kNoTile; }
    bool operator==(const Cell& o) const { return tile == o.tile && index == o.index; }
    bool operator<(const Cell& o) const { return tile != o.tile ? tile < o.tile : index < o.index; }
  };

  struct Label {
    Cost cost = kUnreached;
    Cell before;
  };

  using Entry = std::pair<Cost, Cell>;
  /** The least on top. */
  using Queue = std::priority_queue<Entry, std::vector<Entry>, std::greater<>>;

  /** Where a surface is. */
  struct Place {
    Column column;
    const Surface* surface = nullptr;
    Cell cell;
  };

  /** \param checker must outlive the field. */
  explicit RelaxedField(const CollisionChecker& checker);

  /** The column's drivable surface nearest to a height, at most `tolerance` voxels off; or null. */
  const Surface* near(Column c, int z, int tolerance) const;
  /** The place of that; none: without a surface. */
  Place placeNear(Column c, int z, int tolerance) const;
  Place placeOf(const Cell& cell) const;
  Label& label(const Cell& cell);
  /** Where a place of the vehicle (meters) is, seen from its column, if it heads along a step. */
  Column turned(double x, double y, std::size_t step) const;
  /** The worst rank under the wheels of a vehicle that heads along a step; forbidden, too, where a
   * wheel is over no ground. */
  colored_graph::Rank rankAt(const Place& at, std::size_t step) const;

 private:
  struct Tile {
    const SurfaceTile* surfaces;      ///< null: none
    std::unique_ptr<Label[]> labels;  ///< of its surfaces; null: none is reached
  };

  const CollisionChecker& m_checker;
  const SurfaceGrid& m_surfaces;
  std::array<std::vector<Column>, kSteps.size()> m_wheels;  ///< by step
  std::vector<Tile> m_tiles;                                ///< by number
};

inline const Surface* RelaxedField::near(Column c, int z, int tolerance) const {
  return placeNear(c, z, tolerance).surface;
}

inline RelaxedField::Place RelaxedField::placeNear(Column c, int z, int tolerance) const {
  const std::int32_t number = m_surfaces.numberOf(tileOf(c));
  if (number == SurfaceGrid::kNoTile) return {};
  const SurfaceTile* const tile = m_tiles[static_cast<std::size_t>(number)].surfaces;
  if (!tile) return {};
  const int column = indexInTile(c);
  const Surface* best = nullptr;
  int least = tolerance + 1;
  for (const Surface& s : tile->column(column)) {
    const int off = std::abs(s.z - z);
    if (s.drivable && off < least) best = &s, least = off;
  }
  if (!best) return {};
  const auto index = static_cast<std::uint16_t>(best - tile->surfaces.data());
  return {c, best, {number, index, static_cast<std::uint8_t>(column)}};
}

inline RelaxedField::Place RelaxedField::placeOf(const Cell& cell) const {
  const Column low = firstColumnOf(m_surfaces.tileOfNumber(cell.tile));
  return {{low.x + cell.column % kTileEdge, low.y + cell.column / kTileEdge},
          &m_tiles[static_cast<std::size_t>(cell.tile)].surfaces->surfaces[cell.index],
          cell};
}

inline RelaxedField::Label& RelaxedField::label(const Cell& cell) {
  Tile& tile = m_tiles[static_cast<std::size_t>(cell.tile)];
  if (!tile.labels) tile.labels = std::make_unique<Label[]>(tile.surfaces->surfaces.size());
  return tile.labels[cell.index];
}

/** The least that the rest of a way may cost from the ground around a place on. The vehicle could
 * turn on the spot, and needs no more room than its origin does, however it stands. Classes under
 * its wheels and length count. What nobody asks for is not found out. */
class CostField {
 public:
  using Length = colored_graph::Length;
  static constexpr Length kUnreached = RelaxedField::kUnreached;

  /** \param radius meters; the field is a square */
  CostField(const GroundPose& center, double radius, const CollisionChecker& checker,
            const ClassPrices& prices)
      : m_checker(checker),
        m_prices(prices),
        m_center(checker.ground().columnAt(center.pose.x, center.pose.y)),
        m_reach(static_cast<int>(radius / checker.ground().voxelSize())),
        m_field(checker),
        m_room(roomAround(checker)) {}

  /** A place from which the rest costs so much. */
  void add(const GroundPose& pose, Length cost) {
    if (const Place place = placeAt(pose); place.surface) reach(place, cost);
  }

  /** kUnreached: outside, or there is no way. */
  Length at(const GroundPose& pose) {
    const Place asked = placeAt(pose);
    if (!asked.surface || !contains(asked.column)) return kUnreached;
    const Length& known = m_field.label(asked.cell).cost;
    while (!m_queue.empty() && m_queue.top().first < known) {
      const auto [cost, cell] = m_queue.top();
      m_queue.pop();
      Slices::count(1);
      if (cost == m_field.label(cell).cost) leave(m_field.placeOf(cell), cost);
    }
    return known;
  }

 private:
  /** Share of a way along eight directions: ways between these are up to 8 % shorter. */
  static constexpr double kShortest = 0.96;
  using Place = RelaxedField::Place;

  bool contains(Column c) const {
    return std::max(std::abs(c.x - m_center.x), std::abs(c.y - m_center.y)) <= m_reach;
  }

  /** Surface::clearance2 that the vehicle's origin needs at any heading: each disc's, less its
   * distance from the origin and the rounding of two columns. */
  static int roomAround(const CollisionChecker& checker) {
    const double voxel = checker.ground().voxelSize();
    double room = 0;
    for (const auto& d : checker.discs())
      room =
          std::max(room, std::sqrt(d.needed2) - std::hypot(d.disc.x, d.disc.y) / voxel - M_SQRT2);
    return static_cast<int>(room * room);
  }

  Place placeAt(const GroundPose& pose) const {
    const Ground& ground = m_checker.ground();
    return m_field.placeNear(ground.columnAt(pose.pose.x, pose.pose.y), pose.z, 2 * ground.step());
  }

  void reach(const Place& place, Length cost) {
    if (!contains(place.column)) return;
    Length& known = m_field.label(place.cell).cost;
    if (known <= cost) return;
    known = cost;
    m_queue.emplace(cost, place.cell);
  }

  /** To its neighbors, from each of which a step leads here: whether along the step or back, wheels
   * are over the same columns. */
  void leave(const Place& here, Length cost) {
    const Ground& ground = m_checker.ground();
    for (std::size_t step = 0; step < kSteps.size() / 2; ++step) {
      const colored_graph::Rank rank = m_field.rankAt(here, step);
      if (rank == colored_graph::kForbidden) continue;
      const Length length =
          colored_graph::lengthDown(kShortest * (step % 2 ? M_SQRT2 : 1) * ground.voxelSize());
      for (const std::size_t back : {step, step + kSteps.size() / 2}) {
        const Place from =
            m_field.placeNear(here.column + kSteps[back], here.surface->z, ground.step());
        if (from.surface && from.surface->clearance2 >= m_room)
          reach(from, cost + length + m_prices.ofRank(rank, length));
      }
    }
  }

  const CollisionChecker& m_checker;
  const ClassPrices& m_prices;
  const Column m_center;
  const int m_reach;  ///< columns to each side of it
  RelaxedField m_field;
  const int m_room;  ///< Surface::clearance2 below the origin, at least
  RelaxedField::Queue m_queue;
};

/** The way of a vehicle that could turn on the spot. */
struct RelaxedPath {
  std::vector<PathPoint> path;  ///< headings are those of travel; empty if there is no way
  double price = 0;             ///< meters; hardly any path of the vehicle costs less
  /** Without a way: the place nearest to the goal that can be reached. */
  std::optional<mrpt::math::TPoint2D> nearest;
};

/** What a length of each rank counts, driving it included, in sixteenths of its own. */
constexpr std::int64_t kWeightOfLength = 16;
std::vector<std::int64_t> weightsOfRanks(const colored_graph::ClassOrder& order);

/** From column to column in eight directions, wherever there is ground: the way of least price. It
 * knows no turning radius. Where nothing is near, steps are about as long as half the vehicle
 * is wide. They are single columns where those find no way.
 * \param overForbidden also over what the order forbids, at the price of the worst rank */
RelaxedPath searchRelaxed(const CollisionChecker& checker, const GroundPose& start,
                          const GroundPose& goal, bool overForbidden = false);

}  // namespace semantic_planning
