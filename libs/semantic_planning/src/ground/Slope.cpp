#include "Slope.h"

#include <cmath>

namespace semantic_planning {
namespace {

class SlopeMeter {
 public:
  SlopeMeter(const SurfaceGrid& surfaces, Column tile, const GroundShape& shape)
      : m_surfaces(surfaces, tile, shape.baseline),
        m_shape(shape),
        m_tolerance(shape.step * shape.baseline) {}

  bool isDrivable(Column c, const Surface& s) const {
    const double x = riseAlong(c, s, {m_shape.baseline, 0});
    const double y = riseAlong(c, s, {0, m_shape.baseline});
    const double rise = x == 0 ? y : y == 0 ? x : std::hypot(x, y);
    return rise <= m_shape.rise;
  }

 private:
  /** Rise along an axis, voxels per voxel, between the surfaces at both ends of the baseline; less
   * the one voxel that rounding of heights can make. */
  double riseAlong(Column c, const Surface& s, Column half) const {
    const Surface* before = surfaceNear(m_surfaces, {c.x - half.x, c.y - half.y}, s.z, m_tolerance);
    const Surface* after = surfaceNear(m_surfaces, {c.x + half.x, c.y + half.y}, s.z, m_tolerance);
    const int columns = m_shape.baseline * ((before ? 1 : 0) + (after ? 1 : 0));
    if (columns == 0) return 0;
    const int rise = int(after ? after->z : s.z) - int(before ? before->z : s.z);
    return std::max(0, std::abs(rise) - 1) / double(columns);
  }

  const SurfaceWindow m_surfaces;
  const GroundShape& m_shape;
  const int m_tolerance;
};

}  // namespace

ColumnBox markDrivable(const SurfaceGrid& surfaces, Column tile, SurfaceTile& marked,
                       const GroundShape& shape) {
  ColumnBox changed;
  if (marked.surfaces.empty()) return changed;
  const SlopeMeter meter(surfaces, tile, shape);
  forSurfacesOf(tile, marked, [&](Column c, std::size_t i) {
    Surface& s = marked.surfaces[i];
    const bool drivable = meter.isDrivable(c, s);
    if (s.drivable != drivable) changed.add(c);
    s.drivable = drivable;
  });
  return changed;
}

}  // namespace semantic_planning
