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

bool areSame(const Region& r, const Region& s) {
  return r.shape == s.shape && r.a == s.a && r.b == s.b && r.radius == s.radius &&
         r.weight == s.weight;
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

std::optional<double> DensityField::constantInRegions(const Cell& cell) const {
  double inAll = -1, inPart = -1;  // largest weights
  for (const Region& region : m_regions) {
    const Overlap overlap = this->overlap(region, cell);
    if (overlap == Overlap::None) continue;
    double& largest = overlap == Overlap::Full ? inAll : inPart;
    largest = std::max(largest, region.weight);
  }
  if (inPart > inAll) return {};
  return inAll < 0 ? 1.0 : inAll;
}

double DensityField::meanInRegions(const Cell& cell) const {
  if (const auto density = constantInRegions(cell)) return *density;  // as in all voxels
  double d[8];
  for (int i = 0; i < 8; ++i) d[i] = meanInRegions(cell.child(i));
  return (((d[0] + d[1]) + (d[2] + d[3])) + ((d[4] + d[5]) + (d[6] + d[7]))) * 0.125;
}

DensityChange::DensityChange(const DensityField& before, const DensityField& now)
    : m_before(before), m_now(now), m_moved({}, now.m_resolution) {
  const auto addMissing = [this](const DensityField& from, const DensityField& in) {
    for (const Region& region : from.m_regions)
      if (std::none_of(in.m_regions.begin(), in.m_regions.end(),
                       [&](const Region& r) { return areSame(r, region); }))
        m_moved.m_regions.push_back(region);
  };
  addMissing(before, now);
  addMissing(now, before);
}

bool DensityChange::noneIn(const Cell& cell) const {
  const auto isOff = [&](const Region& region) {
    return m_moved.overlap(region, cell) == DensityField::Overlap::None;
  };
  if (std::all_of(m_moved.m_regions.begin(), m_moved.m_regions.end(), isOff)) return true;
  const auto before = m_before.constantIn(cell);
  return before && before == m_now.constantIn(cell);
}

}  // namespace semantic_octree
