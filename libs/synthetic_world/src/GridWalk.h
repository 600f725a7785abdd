#pragma once
#include <synthetic_world/World.h>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace synthetic_world {

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

}  // namespace synthetic_world
