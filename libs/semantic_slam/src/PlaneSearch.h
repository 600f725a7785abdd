#pragma once
#include <semantic_types/LabeledCloud.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

namespace semantic_slam {

using semantic_types::LabeledCloud;
using PlanePoints = std::vector<Eigen::Vector2d>;

/** What stands upright in a cloud, seen from above: the points of horizontal beams, or, of beams in
 * space, grid columns that reach from low to high.
 * \param cell edge of a column, m; a column counts if it is three times as high */
PlanePoints uprightPoints(const LabeledCloud& cloud, bool isPlanar, double cell);

/** Where in a plane a scan fits best: exhaustive search of a window by branch and bound (Hess et
 * al., "Real-Time Loop Closure in 2D LIDAR SLAM", 2016). For each heading it begins with all of
 * the coarsest squares, in rows as they stand in memory.
 * Scores are integers, so that every machine finds the same. */
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
   * \param looks points that may be looked up before it gives up, less those that were. Whole
   * levels, which are looked up in rows, may take as long again, and count as well.
   * \return nothing if none fits so well, or it gave up */
  std::optional<Found> find(const PlanePoints& scan, const Eigen::Vector3d& guess,
                            const Window& window, double least, std::size_t& looks) const;
  std::optional<Found> find(const PlanePoints& scan, const Eigen::Vector3d& guess,
                            const Window& window, double least) const {
    std::size_t looks = kMostLooks;
    return find(scan, guess, window, least, looks);
  }

  /** Several times what a quarter of a kilometer of trees and fences takes where nothing fits. */
  static constexpr std::size_t kMostLooks = 3'000'000'000;

 private:
  struct Candidate {
    int level, angle, x, y, score;
  };
  class Search;

  static constexpr int kCoarsest = 5, kLevels = kCoarsest + 1;
  static constexpr int kMargin = 1 << kCoarsest;  ///< cells; no square is larger
  void drawPoints(const PlanePoints& points);
  void pool();
  /** Where the highest score in the square of 2^level cells stands that begins at a cell. Of
   * squares side by side these are side by side, of one above the other m_width >> level apart. */
  std::size_t indexOf(int level, int x, int y) const {
    const int mask = (1 << level) - 1, phase = (y & mask) << level | (x & mask);
    const int row = phase * (m_height >> level) + (y >> level);
    return static_cast<std::size_t>(row) * (m_width >> level) + (x >> level);
  }

  double m_cell;
  Eigen::Vector2d m_corner = Eigen::Vector2d::Zero();  ///< without the margin
  int m_width = 0, m_height = 0;                       ///< multiples of the largest square
  std::vector<std::vector<std::uint8_t>> m_levels;
};

}  // namespace semantic_slam
