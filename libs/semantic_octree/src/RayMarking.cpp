#include "RayMarking.h"

#include <semantic_octree/store/Lanes.h>

#include <algorithm>
#include <cmath>

namespace semantic_octree {
namespace {

/** Progress of as many rays as there are lanes along one axis. Which axis is next cannot be
 * predicted: rays go side by side, so that nothing has to be. */
struct AxisLanes {
  Lanes next;         ///< ray parameter (0 begin, 1 end) of the next border
  Lanes delta;        ///< ray parameter from border to border
  LaneBits position;  ///< the axis's part of the bit's position
  LaneBits step;      ///< see ScanGrid::Field
  std::int64_t field;

  MSO_INLINE Lanes deltaWhere(const LaneBits& chosen) const {
    return Lanes(LaneBits(delta) & chosen);
  }
  MSO_INLINE LaneBits movedWhere(const LaneBits& chosen, const LaneBits& at) const {
    return (at + (step & chosen)) & field;
  }
};

/** Bytes, not words: a voxel's neighbors on the ray are often in the same word, and reading what
 * was just written takes time. */
MSO_INLINE void mark(std::uint8_t* bytes, const LaneBits& position) {
  std::int64_t bits[kNumLanes];
  std::memcpy(bits, &position, sizeof bits);
  for (const std::int64_t bit : bits) bytes[bit >> 3] |= static_cast<std::uint8_t>(1 << (bit & 7));
}

class RayLanes {
 public:
  MSO_INLINE RayLanes(ScanGrid& grid, const Eigen::Array3d& begin)
      : m_grid(grid),
        m_bytes(reinterpret_cast<std::uint8_t*>(grid.words())),
        m_begin(begin),
        m_first(begin.cast<int>()) {
    for (int axis = 0; axis < 3; ++axis) m_axes[axis].field = grid.field(axis).mask;
  }

  MSO_INLINE void follow(const Eigen::Array3d* ends, std::size_t numRays) {
    m_next = ends;
    m_last = ends + numRays;
    while (refill()) {
      const std::int64_t steps = *std::min_element(m_left, m_left + kNumLanes);
      advance(steps);
      for (std::int64_t& left : m_left) left -= steps;
    }
    for (int lane = 0; lane < kNumLanes; ++lane) finish(lane);
  }

 private:
  /** Neighbors in a scan would often be in the same byte at the same time, so that one waits for
   * the other: each lane takes this many of them, one after the other. */
  static constexpr std::ptrdiff_t kRaysAtATime = 128;

  struct Part {
    const Eigen::Array3d *next = nullptr, *end = nullptr;
  };

  /** \return whether every lane has a ray */
  MSO_INLINE bool refill() {
    for (int lane = 0; lane < kNumLanes; ++lane)
      while (m_left[lane] == 0)
        if (!startNext(lane)) return false;
    return true;
  }

  MSO_INLINE bool startNext(int lane) {
    Part& part = m_parts[lane];
    if (part.next == part.end) {
      if (m_next == m_last) return false;
      part.next = m_next;
      part.end = m_next += std::min(kRaysAtATime, m_last - m_next);
    }
    start(lane, *part.next++);
    return true;
  }

  /** Follows the rays that are left to a lane. */
  MSO_INLINE void finish(int lane) {
    do
      for (; m_left[lane] > 0; --m_left[lane]) stepAlone(lane);
    while (startNext(lane));
  }

  MSO_INLINE void start(int lane, const Eigen::Array3d& end) {
    m_left[lane] = 0;
    for (int axis = 0; axis < 3; ++axis) {
      AxisLanes& a = m_axes[axis];
      const double length = end[axis] - m_begin[axis];
      const int first = m_first[axis], steps = std::abs(static_cast<int>(end[axis]) - first);
      const double delta = 1.0 / std::fabs(length);
      const double toBorder = length > 0 ? first + 1 - m_begin[axis] : m_begin[axis] - first;
      a.next[lane] = steps > 0 ? toBorder * delta : HUGE_VAL;
      a.delta[lane] = steps > 0 ? delta : 0;
      a.position[lane] = static_cast<std::int64_t>(m_grid.offsets(axis)[first]);
      a.step[lane] = length > 0 ? m_grid.field(axis).up() : m_grid.field(axis).down();
      m_left[lane] += steps;
    }
  }

  /** All lanes take so many steps. What changes is copied, so that it stays in registers. */
  MSO_INLINE void advance(std::int64_t steps) {
    AxisLanes &x = m_axes[0], &y = m_axes[1], &z = m_axes[2];
    Lanes nextX = x.next, nextY = y.next, nextZ = z.next;
    LaneBits atX = x.position, atY = y.position, atZ = z.position;
    std::uint8_t* const bytes = m_bytes;
    for (; steps > 0; --steps) {
      const LaneBits position = atX + atY + atZ;
      const LaneBits isX = (nextX < nextY) & (nextX < nextZ);
      const LaneBits isY = ~isX & (nextY < nextZ);
      const LaneBits isZ = ~(isX | isY);
      nextX += x.deltaWhere(isX), atX = x.movedWhere(isX, atX);
      nextY += y.deltaWhere(isY), atY = y.movedWhere(isY, atY);
      nextZ += z.deltaWhere(isZ), atZ = z.movedWhere(isZ, atZ);
      mark(bytes, position);
    }
    x.next = nextX, y.next = nextY, z.next = nextZ;
    x.position = atX, y.position = atY, z.position = atZ;
  }

  MSO_INLINE void stepAlone(int lane) {
    AxisLanes &x = m_axes[0], &y = m_axes[1], &z = m_axes[2];
    const std::int64_t bit = x.position[lane] + y.position[lane] + z.position[lane];
    m_bytes[bit >> 3] |= static_cast<std::uint8_t>(1 << (bit & 7));
    const bool isX = x.next[lane] < y.next[lane] && x.next[lane] < z.next[lane];
    AxisLanes& a = isX ? x : y.next[lane] < z.next[lane] ? y : z;
    a.next[lane] += a.delta[lane];
    a.position[lane] = (a.position[lane] + a.step[lane]) & a.field;
  }

  ScanGrid& m_grid;
  std::uint8_t* m_bytes;
  Eigen::Array3d m_begin;
  Eigen::Array3i m_first;
  AxisLanes m_axes[3];
  const Eigen::Array3d *m_next = nullptr, *m_last = nullptr;
  Part m_parts[kNumLanes];
  std::int64_t m_left[kNumLanes] = {};
};

}  // namespace

MSO_VECTORIZED void markRays(ScanGrid& grid, const Eigen::Array3d& begin,
                             const Eigen::Array3d* ends, std::size_t numRays) {
  RayLanes lanes(grid, begin);
  lanes.follow(ends, numRays);
}

}  // namespace semantic_octree
