#pragma once
#include <map_pictures/MapCanvas.h>
#include <map_pictures/MapPictures.h>
#include <semantic_octree/Cube.h>
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_types/ClassTable.h>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>
#include <vector>

namespace map_pictures {

using semantic_octree::Cube;

/** Calls visit(node, cube) for a map's nodes, in OctoMap's order; goes below a node only if it is
 * told to. (OctoMap's iterators go everywhere.) */
template <class Visit>
void forEachNode(const semantic_octree::SemanticOcTree& tree, const Visit& visit) {
  const auto walk = [&visit](const auto& self, const semantic_octree::SemanticOcTreeNode& node,
                             const Cube& cube) -> void {
    if (!visit(node, cube) || node.isLeaf()) return;
    for (int i = 0; i < 8; ++i)
      if (const auto child = node.child(i)) self(self, child, cube.child(i));
  };
  if (!tree.empty()) walk(walk, tree.root(), Cube());
}

/** How low a map is around each place: its ground, where that was seen. */
class LowestCells {
 public:
  /** \param center, edge of a cell, m */
  void add(const Eigen::Vector3f& center, float edge) {
    const int left = squareOf(center.x() - edge / 2), right = squareOf(center.x() + edge / 2);
    const int below = squareOf(center.y() - edge / 2), above = squareOf(center.y() + edge / 2);
    for (int y = below; y <= above; ++y)
      for (int x = left; x <= right; ++x)
        if (lower(m_own, x, y, center.z())) addAround(x, y, center.z());
  }

  /** In the square of 1.5 m where a place is, or in one next to it; infinite if there is none. m */
  float around(float x, float y) const {
    const auto found = m_around.find(keyOf(squareOf(x), squareOf(y)));
    return found == m_around.end() ? std::numeric_limits<float>::infinity() : found->second;
  }

 private:
  using Squares = std::unordered_map<std::int64_t, float>;

  static int squareOf(float meters) {
    constexpr float kEdge = 1.5f;
    return static_cast<int>(std::floor(meters / kEdge));
  }
  static std::int64_t keyOf(int x, int y) {
    return std::int64_t(x) * (std::int64_t(1) << 32) + std::uint32_t(y);
  }
  static bool lower(Squares& squares, int x, int y, float z) {
    const auto [square, isNew] = squares.emplace(keyOf(x, y), z);
    if (!isNew && square->second <= z) return false;
    square->second = z;
    return true;
  }
  void addAround(int x, int y, float z) {
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) lower(m_around, x + dx, y + dy, z);
  }

  Squares m_own, m_around;
};

/** A cell that a picture shows: an occupied leaf, or an occupied inner node of the drawn depth. */
struct MapCell {
  octomap::OcTreeKey key;  ///< of its center
  unsigned depth;
  Eigen::Vector3f center;  ///< m
  float size;              ///< edge, m
  semantic_types::ClassId id;
};

/** What a picture shows of a map. */
struct MapCells {
  std::vector<MapCell> cells;
  /** Nothing finer than this depth is drawn. */
  unsigned depth;
  /** Nothing with its center above is drawn, m. */
  double maxHeight = std::numeric_limits<double>::infinity();
  /** Nothing with its center that much above the lowest cells around is drawn, m. */
  double maxAboveGround = std::numeric_limits<double>::infinity();
  LowestCells ground;  ///< for that; empty if nothing is cut off so

  bool isCutOff(const Eigen::Vector3f& center) const {
    return center.z() > maxHeight ||
           (std::isfinite(maxAboveGround) &&
            center.z() - ground.around(center.x(), center.y()) > maxAboveGround);
  }
  /** Number of cells per class, [0] those without. */
  std::vector<std::size_t> countClasses(int numClasses) const;
};

/** The occupied cells of a map, in OctoMap's order; coarser ones if there are more than a picture
 * can show. Cuts off what the style says. \param part where they are, m; none: everywhere */
MapCells collectCells(const semantic_octree::SemanticOcTree& tree, const PictureStyle& style,
                      const std::optional<Eigen::AlignedBox2d>& part = {});

/** The value below which that share of the values is, one of them; changes their order. */
template <class T>
T quantile(std::vector<T>& values, double share) {
  const auto nth = values.begin() + std::ptrdiff_t(share * double(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

/** Where nearly all of the cells are: a few of a thousand far away do not count. */
struct Extent {
  Eigen::Vector3f low, high;
};
Extent extentOf(const std::vector<MapCell>& cells);

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
  /** A pixel per column, shaded as maps are, coarse cells hatched: there is something of that class
   * in them, but they are not full of it. */
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
