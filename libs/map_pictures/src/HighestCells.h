#pragma once
#include <map_pictures/MapCanvas.h>
#include <semantic_types/ClassTable.h>
#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace map_pictures {

/** The color of a pixel in stripes along a diagonal: those of the color, and paler ones.
 * \param x, y of the pixel, not negative \param period from one stripe to the next, pixels */
inline cv::Vec3b hatched(const cv::Vec3b& color, int x, int y, int period) {
  constexpr double kColor = 0.35;
  if (2 * ((x + y) % period) < period) return color;
  const cv::Scalar paper = bgr(kPaper);
  cv::Vec3b pale;
  for (int i = 0; i < 3; ++i)
    pale[i] = cv::saturate_cast<std::uint8_t>(kColor * color[i] + (1 - kColor) * paper[i]);
  return pale;
}

/** The columns of that edge that a cell covers, counted from the map's origin; y counts up. */
cv::Rect columnsUnder(const Eigen::Vector2d& center, double size, double edge);

/** What is seen from above: the highest cell of each column. */
class HighestCells {
 public:
  /** \param columns as columnsUnder() counts them \param edge of a column, m */
  HighestCells(const cv::Rect& columns, double edge);

  /** A cell may be many columns wide, and partly outside. \param center m */
  void add(const Eigen::Vector3d& center, double size, semantic_types::ClassId id);

  /** Number of columns that show each class, [0] none. */
  std::vector<std::size_t> countClasses(int numClasses) const;
  /** A pixel per column in its class's color, paper where there is nothing; the first row is that
   * of the largest y. */
  cv::Mat inColors(const semantic_types::ClassTable& classes) const;
  /** The same, shaded as maps are, coarse cells hatched: there is something of that class in them,
   * but they are not full of it. */
  cv::Mat inRelief(const semantic_types::ClassTable& classes) const;
  bool showsCoarseCells() const { return cv::countNonZero(m_coarse) > 0; }

 private:
  cv::Rect m_columns;
  double m_edge;
  cv::Mat m_height;   ///< upper side, m, 32 bit float; NaN: there is nothing
  cv::Mat m_classId;  ///< 8 bit
  cv::Mat m_coarse;   ///< 8 bit; not 0 where the cell is many columns wide
};

}  // namespace map_pictures
