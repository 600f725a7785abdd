#include "OpenGround.h"

#include <algorithm>
#include <limits>

#include "GroundTiles.h"

namespace semantic_planning {

namespace {

/** Numbers on a square of columns, row by row. */
class Square {
 public:
  Square(int edge, std::int16_t number)
      : m_edge(edge), m_numbers(static_cast<std::size_t>(edge * edge), number) {}
  std::int16_t& at(int x, int y) { return m_numbers[static_cast<std::size_t>(y * m_edge + x)]; }

  /** Replaces each number by that which better(l, r) chooses of those within some columns along x
   * and y; what is nearer to the border than that is none of these. */
  template <class Better>
  void spread(int reach, Better better) {
    for (const int stride : {1, m_edge})
      for (int done = 0, more = 0; done < reach; done += more) {
        more = std::min(2 * done + 1, reach - done);
        const std::vector<std::int16_t> before = m_numbers;
        const std::size_t end = before.size() - 2 * static_cast<std::size_t>(more * stride);
        const std::int16_t *const low = before.data(), *const here = low + more * stride,
                                  *const high = here + more * stride;
        std::int16_t* __restrict const to = m_numbers.data() + more * stride;  // many at a time
        for (std::size_t i = 0; i < end; ++i) to[i] = better(here[i], better(low[i], high[i]));
      }
  }

 private:
  int m_edge;
  std::vector<std::int16_t> m_numbers;
};

constexpr auto lower = [](std::int16_t a, std::int16_t b) { return a < b ? a : b; };
constexpr auto higher = [](std::int16_t a, std::int16_t b) { return a > b ? a : b; };

constexpr std::int16_t kBelowAll = std::numeric_limits<std::int16_t>::min(),
                       kAboveAll = std::numeric_limits<std::int16_t>::max();

}  // namespace

OpenGround::OpenGround(const Ground& ground, const Reach& reach, int needed2)
    : m_ground(ground),
      m_reach(reach),
      m_needed2(needed2),
      m_tiles(ground.layers().surfaces().size()) {}

OpenGround::Room OpenGround::around(Column c) {
  const std::int32_t number = m_ground.layers().surfaces().numberOf(tileOf(c));
  if (number == SurfaceGrid::kNoTile) return {};
  std::unique_ptr<Rooms>& tile = m_tiles[static_cast<std::size_t>(number)];
  if (!tile) tile = std::make_unique<Rooms>(find(tileOf(c)));
  return (*tile)[static_cast<std::size_t>(indexInTile(c))];
}

OpenGround::Rooms OpenGround::find(Column tile) const {
  const int reach = std::max(m_reach.ofDiscs, m_reach.ofWheels), margin = kFarthest + reach,
            edge = kTileEdge + 2 * margin, step = m_ground.step();
  const Column first = firstColumnOf(tile), low{first.x - margin, first.y - margin};
  Square z(edge, 0), lowest(edge, kBelowAll), highest(edge, kAboveAll), fits(edge, 0),
      leastClass(edge, kBelowAll), largestClass(edge, kAboveAll);
  for (int y = 0; y < edge; ++y)
    for (int x = 0; x < edge; ++x) {
      const SurfaceRange range = m_ground.surfaces({low.x + x, low.y + y});
      if (range.last - range.first != 1) continue;
      const Surface& s = *range.first;
      z.at(x, y) = lowest.at(x, y) = highest.at(x, y) = static_cast<std::int16_t>(s.z + kBelowAll);
      leastClass.at(x, y) = largestClass.at(x, y) = s.classId;
      fits.at(x, y) = s.drivable && s.clearance2 >= m_needed2;
    }
  lowest.spread(reach, lower), highest.spread(reach, higher);
  fits.spread(m_reach.ofDiscs, lower);
  leastClass.spread(m_reach.ofWheels, lower), largestClass.spread(m_reach.ofWheels, higher);
  Square free(edge, 0), uniform(edge, 0);
  for (int y = reach; y < edge - reach; ++y)
    for (int x = reach; x < edge - reach; ++x) {
      if (highest.at(x, y) - z.at(x, y) > step || z.at(x, y) - lowest.at(x, y) > step) continue;
      free.at(x, y) = fits.at(x, y);
      uniform.at(x, y) = leastClass.at(x, y) == largestClass.at(x, y);
    }
  Rooms rooms{};
  for (int distance = 1; distance <= kFarthest; ++distance) {
    for (int y = 0; y < kTileEdge; ++y)
      for (int x = 0; x < kTileEdge; ++x) {
        Room& room = rooms[static_cast<std::size_t>(y * kTileEdge + x)];
        if (free.at(margin + x, margin + y)) ++room.ofDiscs;
        if (uniform.at(margin + x, margin + y)) ++room.ofClass;
      }
    free.spread(1, lower), uniform.spread(1, lower);
  }
  return rooms;
}

}  // namespace semantic_planning
