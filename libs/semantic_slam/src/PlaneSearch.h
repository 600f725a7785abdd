#pragma once
#include <semantic_types/LabeledCloud.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

namespace semantic_slam {

using semantic_types::LabeledCloud;
using PlanePoints = std::vector<Eigen::Vector2d>;

/** What stands upright in a cloud, seen from above: the points themselves of horizontal beams, and
 * of beams in space the columns of a grid that reach from low to high.
 * \param cell edge of a column, m; a column counts if it is three times as high */
PlanePoints uprightPoints(const LabeledCloud& cloud, bool isPlanar, double cell);

/** Where in a plane a scan fits best, in a window that may be large: exhaustive search by branch
 * and bound (Hess et al., "Real-Time Loop Closure in 2D LIDAR SLAM", 2016). Scores are integers, so
 * that every machine finds the same. */
class PlaneSearch {
 public:
  /** \param points that others saw, m \param cell edge of the grid's cells, m */
  PlaneSearch(const PlanePoints& points, double cell);

  struct Window {
    double radius;  ///< m, along each axis
    double angle;   ///< radians, to each side
  };
  struct Found {
    Eigen::Vector3d pose;  ///< x, y (m) and heading (radians)
    double score;          ///< share of the points' highest
    bool isAlone;          ///< no other place in the window fits as well
  };
  /** \param guess x, y (m) and heading (radians) of the scan
   * \param least share of the points' highest score that a fit has at least
   * \return nothing if none fits so well */
  std::optional<Found> find(const PlanePoints& scan, const Eigen::Vector3d& guess,
                            const Window& window, double least) const;

 private:
  struct Candidate {
    int level, angle, x, y, score;
  };
  class Search;

  static constexpr int kLevels = 6;  ///< at least
  int numLevels() const { return static_cast<int>(m_levels.size()); }
  void drawPoints(const PlanePoints& points);
  void pool();
  /** Highest score in the square of 2^level cells that begins at a cell. */
  int at(int level, int x, int y) const;
  std::uint8_t& cell(int level, int x, int y) {
    return m_levels[static_cast<std::size_t>(level)][static_cast<std::size_t>(y) * m_width + x];
  }

  double m_cell;
  Eigen::Vector2d m_corner = Eigen::Vector2d::Zero();
  int m_width = 0, m_height = 0;
  std::vector<std::vector<std::uint8_t>> m_levels;
};

}  // namespace semantic_slam
