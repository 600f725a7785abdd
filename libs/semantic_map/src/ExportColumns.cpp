#include "ExportColumns.h"

#include <stdexcept>
#include <string>

namespace semantic_map {

using semantic_octree::SemanticOcTree;

namespace {

constexpr double kMostColumns = 2e8;
constexpr int kKeyOfZero = 32768;

/** x and y keys of the voxels in a leaf. */
cv::Rect keysOf(const SemanticOcTree::leaf_iterator& leaf, unsigned treeDepth) {
  const octomap::OcTreeKey lowest = leaf.getIndexKey();
  const int edge = 1 << (treeDepth - leaf.getDepth());
  return {lowest[0], lowest[1], edge, edge};
}

}  // namespace

ExportColumns::ExportColumns(const SemanticOcTree& tree) : m_resolution(tree.getResolution()) {
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
    m_keys |= keysOf(leaf, tree.getTreeDepth());
  if (m_keys.empty()) throw std::runtime_error("the map is empty");
  if (double(m_keys.width) * m_keys.height > kMostColumns)
    throw std::runtime_error("the map is too wide for a grid, " + std::to_string(m_keys.width) +
                             " x " + std::to_string(m_keys.height) +
                             " voxels: crop it, or make it coarser");
}

cv::Point2d ExportColumns::upperLeft() const {
  return {(m_keys.x - kKeyOfZero) * m_resolution, (m_keys.br().y - kKeyOfZero) * m_resolution};
}

cv::Rect ExportColumns::under(const SemanticOcTree::leaf_iterator& leaf) const {
  constexpr unsigned kTreeDepth = 16;
  const cv::Rect keys = keysOf(leaf, kTreeDepth);
  const cv::Rect pixels(keys.x - m_keys.x, m_keys.br().y - keys.br().y, keys.width, keys.height);
  return pixels & cv::Rect({0, 0}, size());
}

}  // namespace semantic_map
