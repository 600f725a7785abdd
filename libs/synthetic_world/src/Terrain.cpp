#include <synthetic_world/World.h>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace synthetic_world {
namespace {

void check(int halfExtent, const std::vector<Terrain::Wave>& waves) {
  if (halfExtent < 1 || halfExtent > 1000)
    throw std::invalid_argument("terrain: halfExtent is " + std::to_string(halfExtent) +
                                ", 1 to 1000 m expected");
  for (const Terrain::Wave& w : waves) {
    if (!std::isfinite(w.amplitude) || !std::isfinite(w.direction) || !std::isfinite(w.phase))
      throw std::invalid_argument("terrain: a wave is not finite");
    if (!(w.length >= 8))
      throw std::invalid_argument("terrain: a wave of " + std::to_string(w.length) +
                                  " m, 8 m or more expected");
  }
}

double waveHeight(const Terrain::Wave& w, double x, double y) {
  const double along = x * std::cos(w.direction) + y * std::sin(w.direction);
  return w.amplitude * std::sin(2 * M_PI * along / w.length + w.phase);
}

/** Least root in [from, to] of a t^2 + b t + c, which is positive at `from`. */
std::optional<double> firstRoot(double a, double b, double c, double from, double to) {
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return std::nullopt;
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  const double r1 = q != 0 ? c / q : 0, r2 = a != 0 ? q / a : r1;
  for (const double r : {std::min(r1, r2), std::max(r1, r2)})
    if (r >= from && r <= to) return r;
  return std::nullopt;
}

}  // namespace

Terrain::Terrain(int halfExtent, const std::vector<Wave>& waves)
    : m_halfExtent(halfExtent), m_width(2 * halfExtent + 1) {
  check(halfExtent, waves);
  m_nodes.reserve(static_cast<std::size_t>(m_width) * m_width);
  for (int ny = 0; ny < m_width; ++ny)
    for (int nx = 0; nx < m_width; ++nx) {
      double z = 0;
      for (const Wave& w : waves) z += waveHeight(w, nx - halfExtent, ny - halfExtent);
      m_nodes.push_back(z);
    }
  const auto [low, high] = std::minmax_element(m_nodes.begin(), m_nodes.end());
  m_lowest = *low, m_highest = *high;
}

double Terrain::height(double x, double y) const {
  const double fx = std::clamp(x + m_halfExtent, 0.0, 2 * m_halfExtent);
  const double fy = std::clamp(y + m_halfExtent, 0.0, 2 * m_halfExtent);
  const int cx = std::min(static_cast<int>(fx), cells() - 1);
  const int cy = std::min(static_cast<int>(fy), cells() - 1);
  const double u = fx - cx, v = fy - cy;
  return (1 - v) * ((1 - u) * node(cx, cy) + u * node(cx + 1, cy)) +
         v * ((1 - u) * node(cx, cy + 1) + u * node(cx + 1, cy + 1));
}

Eigen::Vector3d Terrain::normal(double x, double y) const {
  const double h = 0.25;
  return Eigen::Vector3d((height(x - h, y) - height(x + h, y)) / (2 * h),
                         (height(x, y - h) - height(x, y + h)) / (2 * h), 1)
      .normalized();
}

double Terrain::cellTop(int cx, int cy) const {
  return std::max(std::max(node(cx, cy), node(cx + 1, cy)),
                  std::max(node(cx, cy + 1), node(cx + 1, cy + 1)));
}

std::optional<double> Terrain::enter(int cx, int cy, const Eigen::Vector3d& o,
                                     const Eigen::Vector3d& d, double from, double to) const {
  // Along the ray, height above the cell's surface is a quadratic polynomial in the range.
  const double z00 = node(cx, cy), zu = node(cx + 1, cy) - z00, zv = node(cx, cy + 1) - z00;
  const double zuv = node(cx + 1, cy + 1) - z00 - zu - zv;
  const double u0 = o.x() + m_halfExtent - cx, v0 = o.y() + m_halfExtent - cy;
  const double a = -zuv * d.x() * d.y();
  const double b = d.z() - zu * d.x() - zv * d.y() - zuv * (u0 * d.y() + v0 * d.x());
  const double c = o.z() - z00 - zu * u0 - zv * v0 - zuv * u0 * v0;
  if ((a * from + b) * from + c <= 0) return from;
  if (const auto root = firstRoot(a, b, c, from, to)) return root;
  // Rounding can hide a root at the very end.
  if ((a * to + b) * to + c <= 0) return to;
  return std::nullopt;
}

}  // namespace synthetic_world
