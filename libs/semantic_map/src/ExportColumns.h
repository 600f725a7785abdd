#pragma once
#include <semantic_octree/Column.h>
#include <semantic_octree/SemanticOcTree.h>

#include <opencv2/core.hpp>

namespace semantic_map {

/** The vertical columns of voxels over (or under) the leaves of a map: the pixels of what is made
 * of it from above. Pixel (0, 0) is at the least x and the largest y. */
class ExportColumns {
 public:
  /** Columns of all leaves.
   * \throw std::runtime_error there are none, or more than a grid can hold. */
  explicit ExportColumns(const semantic_octree::SemanticOcTree& tree);

  cv::Size size() const { return m_keys.size(); }
  /** Edge of a column, m. */
  double resolution() const { return m_resolution; }
  /** Outer corner of pixel (0, 0), m. */
  cv::Point2d upperLeft() const;
  /** Keys of a pixel's column. */
  semantic_octree::Column columnAt(int row, int col) const {
    return {m_keys.x + col, m_keys.br().y - 1 - row};
  }
  /** The columns that a leaf covers, at least in part in the picture. */
  cv::Rect under(const semantic_octree::SemanticOcTree::leaf_iterator& leaf) const;

 private:
  double m_resolution;
  cv::Rect m_keys;  ///< x and y keys of the columns
};

}  // namespace semantic_map
