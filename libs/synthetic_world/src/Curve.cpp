#include <synthetic_world/Solids.h>
#include <synthetic_world/World.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace synthetic_world {
namespace {

constexpr double kStraight = 1e-9;  // radians: corners that turn less are none

/** How a corner is rounded: `tangent` meters are cut off its two edges. */
struct Rounding {
  double turn = 0, tangent = 0;
};

double headingOf(const Eigen::Vector2d& v) { return std::atan2(v.y(), v.x()); }

double turnBetween(const Eigen::Vector2d& in, const Eigen::Vector2d& out) {
  return std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out));
}

Rounding roundCorner(const Eigen::Vector2d& in, const Eigen::Vector2d& out, double radius) {
  Rounding r;
  r.turn = turnBetween(in, out);
  const double shorterHalf = 0.5 * std::min(in.norm(), out.norm());
  r.tangent = std::min(radius * std::tan(std::abs(r.turn) / 2), shorterHalf);
  return r;
}

}  // namespace

Curve::Curve(const std::vector<Eigen::Vector2d>& corners, double radius, bool closed)
    : m_closed(closed) {
  build(corners, radius);
}

void Curve::build(const std::vector<Eigen::Vector2d>& corners, double radius) {
  const std::size_t n = corners.size(), edges = m_closed ? n : n - 1;
  const auto edge = [&](std::size_t i) -> Eigen::Vector2d {
    return corners[(i + 1) % n] - corners[i % n];
  };
  std::vector<Rounding> roundings(n);
  for (std::size_t i = m_closed ? 0 : 1; i < edges; ++i)
    roundings[i] = roundCorner(edge((i + n - 1) % n), edge(i), radius);

  for (std::size_t i = 0; i < edges; ++i) {
    const Eigen::Vector2d direction = edge(i).normalized();
    const Rounding& before = roundings[i];
    const Rounding& after = roundings[(i + 1) % n];
    append(corners[i] + direction * before.tangent, headingOf(direction),
           edge(i).norm() - before.tangent - after.tangent, 0);
    if (std::abs(after.turn) < kStraight) continue;
    const double curvature = std::tan(after.turn / 2) / after.tangent;
    append(corners[(i + 1) % n] - direction * after.tangent, headingOf(direction),
           after.turn / curvature, curvature);
  }
}

void Curve::append(const Eigen::Vector2d& start, double heading, double length, double curvature) {
  if (length <= kStraight) return;
  m_pieces.push_back({start, heading, length, curvature, m_length});
  m_length += length;
}

double Curve::wrapped(double s) const {
  if (!m_closed) return std::clamp(s, 0.0, m_length);
  const double w = std::fmod(s, m_length);
  return w < 0 ? w + m_length : w;
}

const Curve::Piece& Curve::pieceAt(double s) const {
  const auto after = std::upper_bound(m_pieces.begin(), m_pieces.end(), s,
                                      [](double v, const Piece& p) { return v < p.from; });
  return after == m_pieces.begin() ? m_pieces.front() : *(after - 1);
}

Eigen::Vector2d Curve::at(double s) const { return beside(s, 0); }

Eigen::Vector2d Curve::beside(double s, double left) const {
  s = wrapped(s);
  const Piece& p = pieceAt(s);
  const double along = s - p.from, h0 = p.heading, h = h0 + p.curvature * along;
  const Eigen::Vector2d normal(-std::sin(h), std::cos(h));
  if (p.curvature == 0)
    return p.start + along * Eigen::Vector2d(std::cos(h), std::sin(h)) + left * normal;
  const Eigen::Vector2d arc(std::sin(h) - std::sin(h0), std::cos(h0) - std::cos(h));
  return p.start + arc / p.curvature + left * normal;
}

double Curve::heading(double s) const {
  s = wrapped(s);
  const Piece& p = pieceAt(s);
  return p.heading + p.curvature * (s - p.from);
}

double Curve::curvature(double s) const { return pieceAt(wrapped(s)).curvature; }

Curve Curve::parallel(double left) const {
  Curve result;
  result.m_closed = m_closed;
  for (const Piece& p : m_pieces) {
    const double stretch = 1 - p.curvature * left;
    const Eigen::Vector2d normal(-std::sin(p.heading), std::cos(p.heading));
    result.append(p.start + left * normal, p.heading, p.length * stretch, p.curvature / stretch);
  }
  return result;
}

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
