#include <map_view/OrbitCamera.h>

#include <cmath>
#include <limits>

namespace map_view {

using semantic_octree::kKeyOfOrigin;
using semantic_octree::kNumKeys;

namespace {

/** Walks along a ray from cube to cube. All in voxels, from the map's lowest corner. */
class RayWalk {
 public:
  RayWalk(const Ray& ray, double voxelSize)
      : m_origin(ray.origin.array() / voxelSize + kKeyOfOrigin), m_direction(ray.direction) {
    // Into the map, if the ray begins outside.
    double enter = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double d = m_direction[axis], o = m_origin[axis];
      if (d > 0) enter = std::max(enter, -o / d);
      if (d < 0) enter = std::max(enter, (kNumKeys - o) / d);
    }
    m_key = at(enter).floor().cast<int>();
    // Rounding must not leave a ray that enters through a side beside it.
    for (int axis = 0; axis < 3; ++axis)
      if (m_key[axis] == kNumKeys && m_direction[axis] < 0) --m_key[axis];
  }

  const Eigen::Array3i& key() const { return m_key; }
  bool isInMap() const { return (m_key >= 0).all() && (m_key < kNumKeys).all(); }

  void leave(const ViewCell& cell) {
    const Eigen::Array3i end = cell.lowest + cell.edge();
    int through = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const double d = m_direction[axis];
      if (d == 0) continue;
      const double t = ((d > 0 ? end[axis] : cell.lowest[axis]) - m_origin[axis]) / d;
      if (t < least) least = t, through = axis;
    }
    m_key = at(least).floor().cast<int>().max(cell.lowest).min(end - 1);
    m_key[through] = m_direction[through] > 0 ? end[through] : cell.lowest[through] - 1;
  }

 private:
  Eigen::Array3d at(double t) const { return m_origin + t * m_direction; }

  Eigen::Array3d m_origin, m_direction;
  Eigen::Array3i m_key;
};

}  // namespace

std::optional<ViewCell> firstShown(const CellSource& cells, const CellLook& look, const Ray& ray) {
  for (RayWalk walk(ray, cells.map().getResolution()); walk.isInMap();) {
    const ViewCell cell = cells.at(walk.key());
    if (cell.isOccupied() && look.isShown(cell)) return cell;
    walk.leave(cell);
  }
  return {};
}

}  // namespace map_view
