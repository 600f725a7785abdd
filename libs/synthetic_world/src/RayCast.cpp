#include <synthetic_world/World.h>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace synthetic_world {
namespace {

/** The cells of the terrain under a ray, one after the other (Amanatides and Woo 1987). */
class GridWalk {
 public:
  /** The part of the ray between the ranges `from` and `to`, which must lie over the terrain. */
  GridWalk(const Terrain& terrain, const Eigen::Vector3d& o, const Eigen::Vector3d& d, double from,
           double to)
      : m_cells(terrain.cells()), m_enter(from), m_end(to) {
    for (int a = 0; a < 2; ++a) {
      const double start = o[a] + from * d[a] + terrain.halfExtent();
      cell[a] = static_cast<int>(std::clamp(std::floor(start), 0.0, m_cells - 1.0));
      m_step[a] = d[a] > 0 ? 1 : -1;
      m_delta[a] = d[a] == 0 ? kNever : Terrain::kCell / std::abs(d[a]);
      const double border = cell[a] + (d[a] > 0 ? 1 : 0) - terrain.halfExtent();
      m_next[a] = d[a] == 0 ? kNever : (border - o[a]) / d[a];
    }
  }

  int cell[2];
  /** Ranges at which the ray enters and leaves the cell. */
  double enter() const { return m_enter; }
  double leave() const { return std::max(m_enter, std::min({m_next[0], m_next[1], m_end})); }

  /** Goes to the next cell. \return false at the end of the ray or of the terrain. */
  bool advance() {
    const int a = m_next[0] < m_next[1] ? 0 : 1;
    if (m_next[a] >= m_end) return false;
    m_enter = std::max(m_enter, m_next[a]);
    m_next[a] += m_delta[a];
    cell[a] += m_step[a];
    return cell[a] >= 0 && cell[a] < m_cells;
  }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  int m_cells, m_step[2];
  double m_enter, m_end, m_delta[2], m_next[2];
};

/** The nearest entry among those offered so far; solid == nullptr stands for the ground. */
struct Nearest {
  Entry entry{std::numeric_limits<double>::infinity(), Eigen::Vector3d::UnitZ(), 0};
  const Solid* solid = nullptr;

  void offer(const Solid& s, const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
    const auto e = s.enter(o, d);
    if (e && e->range < entry.range) entry = *e, solid = &s;
  }
};

/** Part of the ray that is over the terrain and below `highest`; empty if from > to. */
struct Span {
  double from, to;
};

Span clip(const Eigen::Vector3d& o, const Eigen::Vector3d& d, double halfExtent, double highest,
          double maxRange) {
  Span span{0, maxRange};
  const auto keepBelow = [&](double position, double speed, double limit) {
    if (speed > 0) span.to = std::min(span.to, (limit - position) / speed);
    if (speed < 0) span.from = std::max(span.from, (limit - position) / speed);
    if (speed == 0 && position > limit) span.to = -1;
  };
  for (int a = 0; a < 2; ++a) {
    keepBelow(o[a], d[a], halfExtent);
    keepBelow(-o[a], -d[a], halfExtent);
  }
  keepBelow(o.z(), d.z(), highest);
  return span;
}

}  // namespace

std::optional<Hit> World::castRay(const Eigen::Vector3d& o, const Eigen::Vector3d& d,
                                  double maxRange) const {
  Nearest nearest;
  for (const Solid& s : m_movables) nearest.offer(s, o, d);

  const Span span = clip(o, d, halfExtent(), m_index.highest(), maxRange);
  if (span.from <= span.to) {
    GridWalk walk(m_terrain, o, d, span.from, span.to);
    do {
      const int cx = walk.cell[0], cy = walk.cell[1];
      const double in = walk.enter(), out = walk.leave();
      if (o.z() + std::min(in * d.z(), out * d.z()) > m_index.top(cx, cy)) continue;
      for (const std::uint32_t i : m_index.solids(cx, cy)) nearest.offer(m_solids[i], o, d);
      const auto ground = m_terrain.enter(cx, cy, o, d, in, out);
      if (ground && *ground < nearest.entry.range)
        nearest = {{*ground, Eigen::Vector3d::UnitZ(), 0}, nullptr};
      if (nearest.entry.range <= out) break;
    } while (walk.advance());
  }

  if (!(nearest.entry.range <= maxRange)) return std::nullopt;
  Hit hit{nearest.entry.range, o + nearest.entry.range * d, nearest.entry.normal, {}, false};
  hit.onGround = nearest.solid == nullptr;
  if (hit.onGround) {
    hit.normal = m_terrain.normal(hit.point.x(), hit.point.y());
    hit.material = groundClass(hit.point.x(), hit.point.y());
  } else {
    hit.material = nearest.solid->materialAt(hit.point, nearest.entry.face);
  }
  return hit;
}

}  // namespace synthetic_world
