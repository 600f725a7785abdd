#include "OpenGround.h"

#include <algorithm>
#include <functional>
#include <limits>

#include "GroundTiles.h"

namespace semantic_planning {

/** Small numbers on a square of columns, row by row: many of them are looked at at a time. */
class OpenGround::Square {
 public:
  explicit Square(int edge) : m_edge(edge), m_numbers(static_cast<std::size_t>(edge * edge)) {}
  std::uint8_t* row(int y) { return m_numbers.data() + y * m_edge; }

  /** Replaces each number by the one that better(l, r) chooses within some columns along x and y,
   * except nearer to the border than that. */
  template <class Better>
  void spread(int reach, Better better) {
    for (const int stride : {1, m_edge})
      for (int done = 0, more = 0; done < reach; done += more) {
        more = std::min(2 * done + 1, reach - done);
        const std::vector<std::uint8_t> before = m_numbers;
        const std::size_t end = before.size() - 2 * static_cast<std::size_t>(more * stride);
        const std::uint8_t *const low = before.data(), *const here = low + more * stride,
                                  *const high = here + more * stride;
        std::uint8_t* __restrict const to = m_numbers.data() + more * stride;
        for (std::size_t i = 0; i < end; ++i) to[i] = better(here[i], better(low[i], high[i]));
      }
  }

  /** Replaces each number by f(it, the others' at its place). */
  template <class F, class... Squares>
  void combine(F f, const Squares&... others) {
    combineRows(f, m_numbers.data(), others.m_numbers.data()...);
  }

 private:
  template <class F, class... Rows>
  void combineRows(F f, std::uint8_t* __restrict own, const Rows*... others) {
    const std::size_t end = m_numbers.size();
    for (std::size_t i = 0; i < end; ++i)
      own[i] = static_cast<std::uint8_t>(f(own[i], others[i]...));
  }

  int m_edge;
  std::vector<std::uint8_t> m_numbers;
};

namespace {

constexpr std::uint8_t kMost = std::numeric_limits<std::uint8_t>::max();
constexpr auto lower = [](std::uint8_t a, std::uint8_t b) { return a < b ? a : b; };
constexpr auto higher = [](std::uint8_t a, std::uint8_t b) { return a > b ? a : b; };

}  // namespace

OpenGround::OpenGround(const Ground& ground, const Reach& discs, const Reach& wheels, int needed2)
    : m_ground(ground),
      m_discs(discs),
      m_wheels(wheels),
      m_needed2(needed2),
      m_tiles(ground.layers().surfaces().size()) {}

OpenGround::Room OpenGround::around(Column c) {
  const std::int32_t number = m_ground.layers().surfaces().numberOf(tileOf(c));
  if (number == SurfaceGrid::kNoTile) return {};
  std::unique_ptr<Rooms>& tile = m_tiles[static_cast<std::size_t>(number)];
  if (!tile) tile = std::make_unique<Rooms>(find(tileOf(c)));
  return (*tile)[static_cast<std::size_t>(indexInTile(c))];
}

/** All numbers stay 0 where a column has no surface, several, or one far above or below. */
void OpenGround::read(Column tile, int margin, Square& z, Square& classes, Square& fits) const {
  const SurfaceWindow window(m_ground.layers().surfaces(), tile, margin);
  const Column first = firstColumnOf(tile);
  const std::vector<Surface>& own = window.around(first).surfaces;
  const int base = own.empty() ? 0 : own.front().z - kMost / 2;
  for (int y = 0; y < kTileEdge + 2 * margin; ++y)
    for (int x = 0; x < kTileEdge + 2 * margin; ++x) {
      const SurfaceRange range = surfacesAt(window, {first.x - margin + x, first.y - margin + y});
      if (range.last - range.first != 1) continue;
      const Surface s = *range.first;
      if (s.z <= base || s.z >= base + kMost) continue;
      z.row(y)[x] = static_cast<std::uint8_t>(s.z - base);
      classes.row(y)[x] = s.classId;
      fits.row(y)[x] = s.drivable && s.clearance2 >= m_needed2;
    }
}

OpenGround::Rooms OpenGround::find(Column tile) const {
  const int margin = kFarthest + m_discs.columns, edge = kTileEdge + 2 * margin;
  Square z(edge), leastClass(edge), free(edge);
  read(tile, margin, z, leastClass, free);
  Square lowest = z, highest = z, largestClass = leastClass, uniform = z;
  constexpr auto orMost = [](auto number, auto height) { return height ? number : kMost; };
  highest.combine(orMost, z), largestClass.combine(orMost, z);
  free.spread(m_discs.columns, lower);
  leastClass.spread(m_wheels.columns, lower), largestClass.spread(m_wheels.columns, higher);
  uniform.combine([](auto, auto l, auto h) { return l == h; }, leastClass, largestClass);
  int spread = 0;
  const auto keepLevel = [&](Square& where, const Reach& within) {
    lowest.spread(within.columns - spread, lower), highest.spread(within.columns - spread, higher);
    spread = within.columns;
    const auto most = static_cast<std::uint8_t>(std::min(within.tolerance, kMost - 1));
    const auto isLevel = [most](auto is, auto low, auto here, auto high) {
      const std::uint8_t up = high - here, down = here - low;
      return static_cast<std::uint8_t>(is & (higher(up, down) <= most));
    };
    where.combine(isLevel, lowest, z, highest);
  };
  const Reach nextStep{1, m_ground.step()};
  keepLevel(free, nextStep), keepLevel(uniform, nextStep);
  keepLevel(uniform, m_wheels), keepLevel(free, m_discs);
  return roomsIn(free, uniform, margin);
}

OpenGround::Rooms OpenGround::roomsIn(Square free, Square uniform, int margin) {
  Square ofDiscs(kTileEdge + 2 * margin), ofClass = ofDiscs;
  for (int distance = 1; distance <= kFarthest; ++distance) {
    ofDiscs.combine(std::plus<>(), free), ofClass.combine(std::plus<>(), uniform);
    free.spread(1, lower), uniform.spread(1, lower);
  }
  Rooms rooms;
  for (int y = 0; y < kTileEdge; ++y)
    for (int x = 0; x < kTileEdge; ++x)
      rooms[static_cast<std::size_t>(y * kTileEdge + x)] = {ofDiscs.row(margin + y)[margin + x],
                                                            ofClass.row(margin + y)[margin + x]};
  return rooms;
}

}  // namespace semantic_planning
