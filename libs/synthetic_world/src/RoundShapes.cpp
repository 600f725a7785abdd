#include <synthetic_world/Solids.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace synthetic_world {
namespace {

/** Roots of a t^2 + 2 b t + c, the lesser first. */
std::optional<std::pair<double, double>> roots(double a, double b, double c) {
  const double discriminant = b * b - a * c;
  if (discriminant < 0 || a == 0) return std::nullopt;
  const double root = std::sqrt(discriminant);
  const double first = (-b - root) / a, second = (-b + root) / a;
  return std::minmax(first, second);
}

}  // namespace

double Section::distanceTo(const Polygon& polygon) const {
  if (!outline.empty()) return distance(polygon, outline);
  return std::max(0.0, distance(polygon, center) - radius);
}

std::optional<Entry> Shaft::enter(const Eigen::Vector3d& o, const Eigen::Vector3d& d) const {
  if (signedDistance(o) <= 0) return Entry{0, Eigen::Vector3d::UnitZ(), 0};
  const double k = slope(), rz = radiusAt(o.z());
  const Eigen::Vector2d q = o.head<2>() - center, e = d.head<2>();
  std::optional<Entry> best;
  const auto offer = [&](double t, const Eigen::Vector3d& normal) {
    if (t >= 0 && (!best || t < best->range)) best = Entry{t, normal, 0};
  };
  const auto offerSide = [&](double t) {
    const double z = o.z() + t * d.z();
    if (z < bottom || z > top) return;
    const Eigen::Vector2d out = (q + t * e).normalized();
    offer(t, Eigen::Vector3d(out.x(), out.y(), -k).normalized());
  };
  const auto offerEnd = [&](double z, double radius, double up) {
    const double t = (z - o.z()) / d.z();
    if (radius > 0 && (q + t * e).squaredNorm() <= radius * radius) offer(t, {0, 0, up});
  };
  const double c = q.squaredNorm() - rz * rz;
  if (const auto t = roots(e.squaredNorm() - k * k * d.z() * d.z(), q.dot(e) - k * rz * d.z(), c)) {
    offerSide(t->first);
    offerSide(t->second);
  }
  if (d.z() < 0) offerEnd(top, topRadius, 1);
  if (d.z() > 0) offerEnd(bottom, bottomRadius, -1);
  return best;
}

double Shaft::signedDistance(const Eigen::Vector3d& p) const {
  const double k = slope(), lean = 1 / std::sqrt(1 + k * k);
  const double side = ((p.head<2>() - center).norm() - radiusAt(p.z())) * lean;
  return std::max({side, bottom - p.z(), p.z() - top});
}

std::optional<Section> Shaft::section(double from, double to) const {
  if (to < bottom || from > top) return std::nullopt;
  return Section{
      {}, center, std::max(radiusAt(std::max(from, bottom)), radiusAt(std::min(to, top)))};
}

std::optional<Entry> Spheroid::enter(const Eigen::Vector3d& o, const Eigen::Vector3d& d) const {
  // In coordinates in which the spheroid is the unit ball.
  const Eigen::Vector3d scale(1 / radius, 1 / radius, 1 / halfHeight);
  const Eigen::Vector3d q = (o - center).cwiseProduct(scale), e = d.cwiseProduct(scale);
  const double c = q.squaredNorm() - 1;
  if (c <= 0) return Entry{0, Eigen::Vector3d::UnitZ(), 0};
  const auto t = roots(e.squaredNorm(), q.dot(e), c);
  if (!t || t->first < 0) return std::nullopt;
  return Entry{t->first, (q + t->first * e).cwiseProduct(scale).normalized(), 0};
}

double Spheroid::signedDistance(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d scale(1 / radius, 1 / radius, 1 / halfHeight);
  const Eigen::Vector3d q = (p - center).cwiseProduct(scale);
  const double slope = q.cwiseProduct(scale).norm(), norm = q.norm();
  if (slope == 0) return -std::min(radius, halfHeight);
  return (norm - 1) * norm / slope;
}

std::optional<Section> Spheroid::section(double from, double to) const {
  if (to < low() || from > high()) return std::nullopt;
  const double nearest = std::clamp(center.z(), from, to), h = (nearest - center.z()) / halfHeight;
  return Section{{}, center.head<2>(), radius * std::sqrt(std::max(0.0, 1 - h * h))};
}

}  // namespace synthetic_world
