#include <synthetic_world/World.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace synthetic_world {
namespace {

constexpr double kCell = 2.0;  // meters

}  // namespace

GroundCover::GroundCover(double halfExtent, ClassId background)
    : m_halfExtent(halfExtent),
      m_width(static_cast<int>(std::ceil(2 * halfExtent / kCell))),
      m_background(background),
      m_cells(static_cast<std::size_t>(m_width) * m_width) {}

bool GroundCover::Stroke::covers(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d v = p - start;
  const double along = v.dot(direction);
  if (!round)
    return along >= 0 && along <= length &&
           (v - along * direction).squaredNorm() <= radius * radius;
  return (v - std::clamp(along, 0.0, length) * direction).squaredNorm() <= radius * radius;
}

int GroundCover::cellOf(double coordinate) const {
  const double cell = std::floor((coordinate + m_halfExtent) / kCell);
  return static_cast<int>(std::clamp(cell, 0.0, m_width - 1.0));
}

void GroundCover::paint(const Stroke& stroke) {
  if (!(stroke.radius > 0)) throw std::invalid_argument("ground cover: a stroke without width");
  const Eigen::Vector2d end = stroke.start + stroke.length * stroke.direction;
  const Eigen::Vector2d low = stroke.start.cwiseMin(end).array() - stroke.radius;
  const Eigen::Vector2d high = stroke.start.cwiseMax(end).array() + stroke.radius;
  for (int cy = cellOf(low.y()); cy <= cellOf(high.y()); ++cy)
    for (int cx = cellOf(low.x()); cx <= cellOf(high.x()); ++cx)
      m_cells[cy * m_width + cx].push_back(static_cast<std::uint32_t>(m_strokes.size()));
  m_strokes.push_back(stroke);
}

void GroundCover::paintStroke(ClassId id, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                              double radius) {
  const double length = (b - a).norm();
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();
  if (length > 0) direction = (b - a) / length;
  paint({a, direction, length, radius, true, id});
}

void GroundCover::paintBand(ClassId id, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                            double width) {
  const double length = (b - a).norm();
  if (!(length > 0)) throw std::invalid_argument("ground cover: a band without length");
  paint({a, (b - a) / length, length, width / 2, false, id});
}

void GroundCover::paintCurve(ClassId id, const Curve& curve, double radius) {
  const int pieces = std::max(1, static_cast<int>(std::ceil(curve.length() / 1.5)));
  const double step = curve.length() / pieces;
  for (int i = 0; i < pieces; ++i)
    paintStroke(id, curve.at(i * step), curve.at((i + 1) * step), radius);
}

ClassId GroundCover::at(double x, double y) const {
  const auto& cell = m_cells[cellOf(y) * m_width + cellOf(x)];
  for (auto i = cell.rbegin(); i != cell.rend(); ++i)
    if (m_strokes[*i].covers({x, y})) return m_strokes[*i].id;
  return m_background;
}

}  // namespace synthetic_world
