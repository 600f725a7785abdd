#include "Slope.h"

#include <cmath>

namespace semantic_planning {
namespace {

/** Rise along an axis, voxels per voxel, between the surfaces at both ends of the baseline; less
 * the one voxel that rounding of heights can make. */
double riseAlong(const SurfaceGrid& surfaces, Column c, const Surface& s, Column axis, int baseline,
                 int tolerance) {
  const auto end = [&](int side) {
    const Column there{c.x + side * baseline * axis.x, c.y + side * baseline * axis.y};
    return surfaceNear(surfaces, there, s.z, tolerance);
  };
  const Surface *before = end(-1), *after = end(1);
  const int columns = (before ? baseline : 0) + (after ? baseline : 0);
  if (columns == 0) return 0;
  const int rise = int(after ? after->z : s.z) - int(before ? before->z : s.z);
  return std::max(0, std::abs(rise) - 1) / double(columns);
}

}  // namespace

void markDrivable(const SurfaceGrid& surfaces, Column tile, SurfaceTile& marked,
                  const GroundShape& shape) {
  const int tolerance = shape.step * shape.baseline;
  forColumnsOf(tile, [&](Column c) {
    const int index = indexInTile(c);
    for (int i = marked.first[index]; i < marked.first[index + 1]; ++i) {
      Surface& s = marked.surfaces[i];
      const double x = riseAlong(surfaces, c, s, {1, 0}, shape.baseline, tolerance);
      const double y = riseAlong(surfaces, c, s, {0, 1}, shape.baseline, tolerance);
      s.drivable = std::hypot(x, y) <= shape.rise;
    }
  });
}

}  // namespace semantic_planning
