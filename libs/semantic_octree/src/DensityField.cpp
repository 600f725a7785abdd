#include "DensityField.h"

#include <algorithm>
#include <cmath>

namespace semantic_octree {
namespace {

/** Distance from a point to the stretch a-b (to a if both are the same). */
double distanceToStretch(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                         const Eigen::Vector3d& b) {
  const Eigen::Vector3d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).norm();
}

}  // namespace

DensityField::DensityField(std::vector<Region> regions, double resolution)
    : m_regions(std::move(regions)), m_resolution(resolution) {}

DensityField::Overlap DensityField::overlap(const Region& region, const Cell& cell) const {
  // Centers of the cell's voxels fill the box center +- reach.
  const double reach = 0.5 * (cell.edge() - 1) * m_resolution;
  const Eigen::Vector3d center =
      ((cell.lowest() - kKeyOfOrigin).cast<double>() + 0.5 * cell.edge()).matrix() * m_resolution;
  if (region.shape == Region::Shape::Box) {
    const Eigen::Array3d toLow = (center - region.a).array(), toHigh = (region.b - center).array();
    if ((toLow >= reach).all() && (toHigh >= reach).all()) return Overlap::Full;
    if ((toLow < -reach).any() || (toHigh < -reach).any()) return Overlap::None;
    return Overlap::Part;
  }
  const double distance = region.shape == Region::Shape::Sphere
                              ? (center - region.a).norm()
                              : distanceToStretch(center, region.a, region.b);
  const double halfDiagonal = std::sqrt(3.0) * reach;
  if (distance + halfDiagonal <= region.radius) return Overlap::Full;
  return distance - halfDiagonal > region.radius ? Overlap::None : Overlap::Part;
}

bool DensityField::constantIn(const Cell& cell, double& density) const {
  double largest = -1;
  bool part = false;
  for (const Region& region : m_regions) switch (overlap(region, cell)) {
      case Overlap::None:
        break;
      case Overlap::Part:
        part = true;
        break;
      case Overlap::Full:
        largest = std::max(largest, region.weight);
    }
  density = largest < 0 ? 1.0 : largest;
  return !part;
}

double DensityField::meanInRegions(const Cell& cell) const {
  double density;
  if (constantIn(cell, density) || cell.depth == kTreeDepth) return density;
  double d[8];
  for (int i = 0; i < 8; ++i) d[i] = meanInRegions(cell.child(i));
  return (((d[0] + d[1]) + (d[2] + d[3])) + ((d[4] + d[5]) + (d[6] + d[7]))) * 0.125;
}

bool DensityField::sameIn(const DensityField& a, const DensityField& b, const Cell& cell) {
  double densityA, densityB;
  return a.constantIn(cell, densityA) && b.constantIn(cell, densityB) && densityA == densityB;
}

}  // namespace semantic_octree
