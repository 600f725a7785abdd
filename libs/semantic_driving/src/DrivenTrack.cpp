#include <mrpt/math/wrap2pi.h>
#include <semantic_driving/DrivePath.h>

#include <cmath>

namespace semantic_driving {

using mrpt::math::TPose2D;
using semantic_planning::PathPoint;

namespace {

constexpr double kSpacing = 0.1;      // m
constexpr double kSameHeading = 0.2;  // rad

double apart(const TPose2D& a, const TPose2D& b) { return std::hypot(a.x - b.x, a.y - b.y); }

bool isSame(const TPose2D& a, const TPose2D& b) {
  return apart(a, b) < kSpacing && std::abs(mrpt::math::wrapToPi(a.phi - b.phi)) < kSameHeading;
}

/** The steering's curvature from one place to the other, 1/m; the gear does not matter. */
double curvature(const TPose2D& a, const TPose2D& b) {
  const double turned = mrpt::math::wrapToPi(b.phi - a.phi), heading = a.phi + turned / 2;
  const double way = (b.x - a.x) * std::cos(heading) + (b.y - a.y) * std::sin(heading);
  return std::abs(way) > kSpacing / 2 ? turned / way : 0;
}

}  // namespace

void DrivenTrack::add(const TPose2D& pose) {
  while (m_poses.size() > 1 && isSame(pose, m_poses[m_poses.size() - 2])) m_poses.pop_back();
  if (m_poses.empty() || apart(pose, m_poses.back()) >= kSpacing) m_poses.push_back(pose);
  const auto most = static_cast<std::size_t>(m_length / kSpacing);
  while (m_poses.size() > most) m_poses.pop_front();
}

std::vector<PathPoint> DrivenTrack::back() const {
  std::vector<PathPoint> points;
  for (auto pose = m_poses.rbegin(); pose != m_poses.rend(); ++pose) {
    PathPoint p;
    p.x = pose->x, p.y = pose->y, p.heading = pose->phi;
    if (pose + 1 != m_poses.rend()) p.curvature = curvature(*pose, *(pose + 1));
    points.push_back(p);
  }
  return points;
}

}  // namespace semantic_driving
