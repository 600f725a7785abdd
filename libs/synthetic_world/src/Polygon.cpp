#include <synthetic_world/Solids.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace synthetic_world {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

Eigen::Vector2d edge(const Polygon& p, std::size_t i) { return p[(i + 1) % p.size()] - p[i]; }

double distanceToSegment(const Eigen::Vector2d& a, const Eigen::Vector2d& ab,
                         const Eigen::Vector2d& point) {
  const double along = std::clamp((point - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return (point - a - along * ab).norm();
}

/** Does an edge of `a` have all of `b` on its outer side? */
bool edgeSeparates(const Polygon& a, const Polygon& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::all_of(b.begin(), b.end(),
                    [&](const auto& v) { return cross(edge(a, i), v - a[i]) < 0; }))
      return true;
  return false;
}

}  // namespace

void requireConvex(const Polygon& polygon, const char* what) {
  bool convex = polygon.size() >= 3;
  double turned = 0;
  for (std::size_t i = 0; convex && i < polygon.size(); ++i) {
    const Eigen::Vector2d in = edge(polygon, i), out = edge(polygon, (i + 1) % polygon.size());
    convex = cross(in, out) > 0;
    turned += std::atan2(cross(in, out), in.dot(out));
  }
  if (!convex || turned > 2 * M_PI + 1e-6)
    throw std::invalid_argument(std::string(what) +
                                ": three or more corners, convex, counterclockwise expected");
}

Polygon rectangle(const Eigen::Vector2d& center, double yaw, double length, double width) {
  const double l = length / 2, w = width / 2;
  return placed({{-l, -w}, {l, -w}, {l, w}, {-l, w}}, center, yaw);
}

Polygon placed(const Polygon& polygon, const Eigen::Vector2d& position, double yaw) {
  const double c = std::cos(yaw), s = std::sin(yaw);
  Polygon result;
  for (const Eigen::Vector2d& v : polygon)
    result.emplace_back(position.x() + c * v.x() - s * v.y(), position.y() + s * v.x() + c * v.y());
  return result;
}

double distance(const Polygon& polygon, const Eigen::Vector2d& point) {
  bool inside = true;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if (cross(edge(polygon, i), point - polygon[i]) < 0) inside = false;
    least = std::min(least, distanceToSegment(polygon[i], edge(polygon, i), point));
  }
  return inside ? 0 : least;
}

double distance(const Polygon& a, const Polygon& b) {
  if (!edgeSeparates(a, b) && !edgeSeparates(b, a)) return 0;
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& v : b) least = std::min(least, distance(a, v));
  for (const Eigen::Vector2d& v : a) least = std::min(least, distance(b, v));
  return least;
}

}  // namespace synthetic_world
