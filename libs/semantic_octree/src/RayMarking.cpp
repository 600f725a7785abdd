#include "RayMarking.h"

#include <cmath>

namespace semantic_octree {
namespace {

/** Progress of a ray along one axis. */
struct Axis {
  int index;      ///< voxel
  int step;       ///< +1, -1, or 0: stays in this voxel
  int remaining;  ///< steps to the end voxel
  double next;    ///< ray parameter (0 begin, 1 end) of the next border
  double delta;   ///< ray parameter from border to border

  Axis(double begin, double end)
      : index(static_cast<int>(begin)),
        step(end > begin ? 1 : -1),
        remaining((static_cast<int>(end) - index) * step) {
    if (remaining <= 0) {
      remaining = step = 0;
      next = HUGE_VAL;
      delta = 0;
      return;
    }
    delta = 1.0 / std::fabs(end - begin);
    next = (step > 0 ? index + 1 - begin : begin - index) * delta;
  }
};

}  // namespace

void markRay(TileGrid& grid, const Eigen::Array3d& begin, const Eigen::Array3d& end) {
  Axis x(begin.x(), end.x()), y(begin.y(), end.y()), z(begin.z(), end.z());
  const std::uint64_t *xs = grid.xOffsets() + x.index, *ys = grid.yOffsets() + y.index,
                      *zs = grid.zOffsets() + z.index;
  std::uint64_t xBit = *xs, yBit = *ys, zBit = *zs;
  std::uint64_t* const words = grid.words();
  for (int n = x.remaining + y.remaining + z.remaining; n > 0; --n) {
    const std::uint64_t bit = xBit + yBit + zBit;
    words[bit >> 6] |= std::uint64_t(1) << (bit & 63);
    if (x.next < y.next && x.next < z.next) {
      xBit = *(xs += x.step);
      x.next += x.delta;
    } else if (y.next < z.next) {
      yBit = *(ys += y.step);
      y.next += y.delta;
    } else {
      zBit = *(zs += z.step);
      z.next += z.delta;
    }
  }
}

}  // namespace semantic_octree
