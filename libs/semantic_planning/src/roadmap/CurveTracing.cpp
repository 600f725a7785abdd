#include <semantic_planning/roadmap/CollisionChecker.h>

#include <algorithm>
#include <cmath>

namespace semantic_planning {
namespace {

/** Arc lengths of points at most half a voxel apart, among them the ends of all segments. */
std::vector<double> stations(const ReedsSheppCurve& curve, double voxelSize) {
  std::vector<double> at = {0};
  double begin = 0;
  for (const ReedsSheppCurve::Segment& segment : curve.segments()) {
    const double length = std::abs(segment.length);
    if (length < 1e-6) continue;  // what rounding leaves
    const int n = std::max(1, static_cast<int>(std::ceil(length / (voxelSize / 2))));
    for (int i = 1; i <= n; ++i) at.push_back(begin + length * i / n);
    begin += length;
  }
  return at;
}

}  // namespace

std::vector<PathPoint> CollisionChecker::trace(const ReedsSheppCurve& curve, int z) const {
  std::vector<PathPoint> points;
  for (const double s : stations(curve, m_ground.voxelSize())) {
    const CurvePoint c = curve.at(s);
    const Surface* surface =
        m_ground.near(m_ground.columnAt(c.pose.x, c.pose.y), z, m_ground.step());
    if (surface) z = surface->z;
    PathPoint p;
    p.x = c.pose.x, p.y = c.pose.y, p.z = m_ground.centerOf(z), p.heading = c.pose.phi;
    p.curvature = c.curvature, p.forward = c.forward;
    p.classId = classAt({c.pose, z});
    p.arcLength = s;
    points.push_back(p);
  }
  return points;
}

}  // namespace semantic_planning
