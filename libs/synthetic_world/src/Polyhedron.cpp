#include <synthetic_world/Solids.h>
#include <Eigen/Geometry>
#include <limits>
#include <stdexcept>

namespace synthetic_world {
namespace {

Eigen::Vector3d lifted(const Eigen::Vector2d& p, double z) { return {p.x(), p.y(), z}; }

}  // namespace

Polyhedron::Polyhedron(const Polygon& bottom, const Polygon& top, double low, double high)
    : m_outline(bottom), m_low(low), m_high(high) {
  requireConvex(bottom, "polyhedron");
  if (top.size() != bottom.size())
    throw std::invalid_argument("polyhedron: top and bottom differ in their number of corners");
  if (!(low < high)) throw std::invalid_argument("polyhedron: its top is not above its bottom");
  for (std::size_t i = 0; i < bottom.size(); ++i) {
    const std::size_t j = (i + 1) % bottom.size();
    addSide(lifted(bottom[i], low), lifted(bottom[j], low), lifted(top[i], high));
  }
  m_faces.push_back({Eigen::Vector3d::UnitZ(), high, 0, 0});
  m_faces.push_back({-Eigen::Vector3d::UnitZ(), -low, 0, 0});
}

Polyhedron Polyhedron::gable(const Eigen::Vector2d& center, double yaw, double length, double width,
                             double low, double high) {
  if (!(low < high)) throw std::invalid_argument("gable: its ridge is not above its eaves");
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
