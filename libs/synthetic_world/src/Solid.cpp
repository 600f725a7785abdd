#include <synthetic_world/Solids.h>

#include <algorithm>
#include <cmath>

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

}  // namespace synthetic_world
