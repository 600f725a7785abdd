#include <synthetic_world/Solids.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace synthetic_world {
namespace {

// Windows: meters.
constexpr double kWindowLow = 1.0, kWindowHigh = 2.3;
constexpr double kWindowPitch = 2.4, kWindowWidth = 1.2;

Eigen::Vector2d middleOf(const Polygon& polygon) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& v : polygon) sum += v;
  return sum / static_cast<double>(polygon.size());
}

}  // namespace

Solid::Solid(Shape shape, Material side, Material top)
    : m_shape(std::move(shape)), m_side(side), m_top(top) {
  const Section all = *section(low(), high());
  m_center = all.outline.empty() ? all.center : middleOf(all.outline);
  m_radius = all.radius;
  for (const Eigen::Vector2d& v : all.outline) m_radius = std::max(m_radius, (v - m_center).norm());
}

Solid& Solid::withWindows(double floor) {
  m_windowFloor = floor;
  return *this;
}

std::optional<Entry> Solid::enter(const Eigen::Vector3d& o, const Eigen::Vector3d& d) const {
  return std::visit([&](const auto& s) { return s.enter(o, d); }, m_shape);
}

double Solid::signedDistance(const Eigen::Vector3d& p) const {
  return std::visit([&](const auto& s) { return s.signedDistance(p); }, m_shape);
}

std::optional<Section> Solid::section(double from, double to) const {
  return std::visit([&](const auto& s) { return s.section(from, to); }, m_shape);
}

double Solid::low() const {
  return std::visit([](const auto& s) { return s.low(); }, m_shape);
}

double Solid::high() const {
  return std::visit([](const auto& s) { return s.high(); }, m_shape);
}

bool Solid::isWindow(const Polyhedron::Face& face, const Eigen::Vector3d& p) const {
  const double above = p.z() - *m_windowFloor,
               inStorey = above - kStorey * std::floor(above / kStorey);
  if (above < 0 || inStorey < kWindowLow || inStorey > kWindowHigh) return false;
  // A storey that is not a whole one has none; a whole one may end at the very top.
  if (p.z() + kStorey - inStorey > high() + 0.1) return false;
  const double u = -face.normal.y() * p.x() + face.normal.x() * p.y() - face.u0;
  const int count = static_cast<int>(face.width / kWindowPitch);
  const double margin = (face.width - count * kWindowPitch) / 2,
               across = (u - margin) / kWindowPitch;
  if (across < 0 || across > count) return false;
  return std::abs(across - std::floor(across) - 0.5) < 0.5 * kWindowWidth / kWindowPitch;
}

Material Solid::materialAt(const Eigen::Vector3d& p, int index) const {
  const auto* polyhedron = std::get_if<Polyhedron>(&m_shape);
  if (!polyhedron) return m_side;
  const Polyhedron::Face& face = polyhedron->face(index);
  if (face.normal.z() > 0.3) return m_top;
  if (m_windowFloor && std::abs(face.normal.z()) < 0.01 && isWindow(face, p)) return kWindow;
  return m_side;
}

Material Solid::materialAt(const Eigen::Vector3d& p) const {
  const int face = std::visit([&](const auto& s) { return s.nearestFace(p); }, m_shape);
  return materialAt(p, face);
}

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

namespace {

Eigen::Vector3d lifted(const Eigen::Vector2d& p, double z) { return {p.x(), p.y(), z}; }

}  // namespace

Polyhedron::Polyhedron(const Polygon& bottom, const Polygon& top, double low, double high)
    : m_outline(bottom), m_low(low), m_high(high) {
  for (std::size_t i = 0; i < bottom.size(); ++i) {
    const std::size_t j = (i + 1) % bottom.size();
    addSide(lifted(bottom[i], low), lifted(bottom[j], low), lifted(top[i], high));
  }
  m_faces.push_back({Eigen::Vector3d::UnitZ(), high, 0, 0});
  m_faces.push_back({-Eigen::Vector3d::UnitZ(), -low, 0, 0});
}

Polyhedron Polyhedron::gable(const Eigen::Vector2d& center, double yaw, double length, double width,
                             double low, double high) {
  Polyhedron p;
  p.m_outline = rectangle(center, yaw, length, width);
  p.m_low = low, p.m_high = high;
  const Polygon& o = p.m_outline;
  const Eigen::Vector3d back = lifted((o[0] + o[3]) / 2, high),
                        front = lifted((o[1] + o[2]) / 2, high);
  p.addSide(lifted(o[0], low), lifted(o[1], low), back);
  p.addSide(lifted(o[1], low), lifted(o[2], low), front);
  p.addSide(lifted(o[2], low), lifted(o[3], low), front);
  p.addSide(lifted(o[3], low), lifted(o[0], low), back);
  p.m_faces.push_back({-Eigen::Vector3d::UnitZ(), -low, 0, 0});
  return p;
}

void Polyhedron::addSide(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                         const Eigen::Vector3d& above) {
  const Eigen::Vector3d normal = (b - a).cross(above - a).normalized();
  const Eigen::Vector3d along = (b - a).normalized();
  m_faces.push_back({normal, normal.dot(a), along.dot(a), (b - a).norm()});
}

std::optional<Entry> Polyhedron::enter(const Eigen::Vector3d& o, const Eigen::Vector3d& d) const {
  double in = 0, out = std::numeric_limits<double>::infinity();
  int face = -1;
  for (int i = 0; i < static_cast<int>(m_faces.size()); ++i) {
    const double toward = m_faces[i].normal.dot(d),
                 gap = m_faces[i].offset - m_faces[i].normal.dot(o);
    if (toward == 0) {
      if (gap < 0) return std::nullopt;
      continue;
    }
    const double range = gap / toward;
    if (toward > 0) {
      out = std::min(out, range);
    } else if (range > in) {
      in = range, face = i;
    }
    if (in > out) return std::nullopt;
  }
  if (face < 0) face = nearestFace(o);
  return Entry{in, m_faces[face].normal, face};
}

int Polyhedron::nearestFace(const Eigen::Vector3d& p) const {
  int nearest = 0;
  double greatest = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < static_cast<int>(m_faces.size()); ++i) {
    const double outside = m_faces[i].normal.dot(p) - m_faces[i].offset;
    if (outside > greatest) greatest = outside, nearest = i;
  }
  return nearest;
}

double Polyhedron::signedDistance(const Eigen::Vector3d& p) const {
  const Face& f = m_faces[nearestFace(p)];
  return f.normal.dot(p) - f.offset;
}

std::optional<Section> Polyhedron::section(double low, double high) const {
  if (high < m_low || low > m_high) return std::nullopt;
  return Section{m_outline, Eigen::Vector2d::Zero(), 0};
}

}  // namespace synthetic_world
