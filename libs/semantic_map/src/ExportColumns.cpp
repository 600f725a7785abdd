#include "ExportColumns.h"

#include <semantic_octree/Keys.h>

#include <stdexcept>
#include <string>

namespace semantic_map {

using semantic_octree::SemanticOcTree;

namespace {

constexpr double kMostColumns = 2e8;

/** x and y keys of the voxels in a leaf. */
cv::Rect keysOf(const SemanticOcTree::leaf_iterator& leaf) {
  const octomap::OcTreeKey lowest = leaf.getIndexKey();
  const int edge = semantic_octree::edgeAtDepth(static_cast<int>(leaf.getDepth()));
  return {lowest[0], lowest[1], edge, edge};
}

}  // namespace

ExportColumns::ExportColumns(const SemanticOcTree& tree) : m_resolution(tree.getResolution()) {
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
    m_keys |= keysOf(leaf);
  if (m_keys.empty()) throw std::runtime_error("the map is empty");
  if (double(m_keys.width) * m_keys.height > kMostColumns)
    throw std::runtime_error("the map is too wide for a grid, " + std::to_string(m_keys.width) +
                             " x " + std::to_string(m_keys.height) +
                             " voxels: crop it, or make it coarser");
}

cv::Point2d ExportColumns::upperLeft() const {
  return {semantic_octree::lowerBorderOf(m_keys.x, m_resolution),
          semantic_octree::lowerBorderOf(m_keys.br().y, m_resolution)};
}

cv::Rect ExportColumns::under(const SemanticOcTree::leaf_iterator& leaf) const {
  const cv::Rect keys = keysOf(leaf);
  const cv::Rect pixels(keys.x - m_keys.x, m_keys.br().y - keys.br().y, keys.width, keys.height);
  return pixels & cv::Rect({0, 0}, size());
}

}  // namespace semantic_map
