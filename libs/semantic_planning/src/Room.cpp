#include "Room.h"

#include <algorithm>
#include <tuple>

namespace semantic_planning {
namespace {

/** A column where the vehicle must not be, for surfaces at about the height z. */
struct Obstacle {
  Column column;
  int z;
  bool operator<(const Obstacle& o) const { return std::tie(column, z) < std::tie(o.column, o.z); }
  bool operator==(const Obstacle& o) const { return column == o.column && z == o.z; }
};

class Obstacles {
 public:
  Obstacles(const SurfaceGrid& surfaces, const GroundShape& shape)
      : m_surfaces(surfaces), m_shape(shape) {}

  /** All that are next to free ground and no farther from the tile than the farthest room. */
  std::vector<Obstacle> around(Column tile) {
    forColumnsAround(tile, m_shape.farthestRoom, [&](Column c) {
      for (const Surface& s : surfacesAt(m_surfaces, c)) addAround(c, s);
    });
    std::sort(m_found.begin(), m_found.end());
    m_found.erase(std::unique(m_found.begin(), m_found.end()), m_found.end());
    return std::move(m_found);
  }

 private:
  bool isFree(const Surface& s) const { return s.drivable && !m_shape.keepOff[s.classId]; }

  void addAround(Column c, const Surface& s) {
    if (!isFree(s)) return m_found.push_back({c, s.z});
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const Column next{c.x + x, c.y + y};
        if (!surfaceNear(m_surfaces, next, s.z, m_shape.step)) m_found.push_back({next, s.z});
      }
  }

  const SurfaceGrid& m_surfaces;
  const GroundShape& m_shape;
  std::vector<Obstacle> m_found;
};

int between(int a, int b) { return std::max(0, std::abs(a - b) - 1); }

/** How far ground may have gone up or down on the way: what differs by more is another level. */
int levelTolerance(int columns, const GroundShape& shape) {
  return std::min(shape.height, 2 * shape.step + 1 + static_cast<int>(shape.rise * columns));
}

/** Lowers the room of the tile's surfaces near an obstacle. */
void stamp(const Obstacle& o, Column tile, SurfaceTile& measured, const GroundShape& shape) {
  const Column low = firstColumnOf(tile);
  const int reach = shape.farthestRoom;
  const int xEnd = std::min(low.x + kTileEdge, o.column.x + reach + 1);
  const int yEnd = std::min(low.y + kTileEdge, o.column.y + reach + 1);
  for (int y = std::max(low.y, o.column.y - reach); y < yEnd; ++y)
    for (int x = std::max(low.x, o.column.x - reach); x < xEnd; ++x) {
      const int dx = between(x, o.column.x), dy = between(y, o.column.y);
      const int room2 = dx * dx + dy * dy;
      const int tolerance = levelTolerance(std::max(dx, dy) + 1, shape);
      const int index = indexInTile({x, y});
      for (int i = measured.first[index]; i < measured.first[index + 1]; ++i) {
        Surface& s = measured.surfaces[i];
        if (room2 < s.room2 && std::abs(int(s.z) - o.z) <= tolerance)
          s.room2 = static_cast<std::uint16_t>(room2);
      }
    }
}

}  // namespace

void measureRoom(const SurfaceGrid& surfaces, Column tile, SurfaceTile& measured,
                 const GroundShape& shape) {
  const int farthest = shape.farthestRoom * shape.farthestRoom;
  for (Surface& s : measured.surfaces) s.room2 = static_cast<std::uint16_t>(farthest);
  if (measured.surfaces.empty()) return;
  for (const Obstacle& o : Obstacles(surfaces, shape).around(tile)) stamp(o, tile, measured, shape);
}

}  // namespace semantic_planning
