#include <map_pictures/ClassMap.h>
#include <map_pictures/Sheet.h>

#include <algorithm>
#include <iomanip>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <stdexcept>

#include "HighestCells.h"
#include "MapCells.h"
#include "NodeWalk.h"

namespace map_pictures {

using semantic_octree::SemanticOcTree;

namespace {

/** All columns of voxels with something in them. What lies within those that are known already is
 * not looked at. */
cv::Rect occupiedColumns(const SemanticOcTree& tree) {
  constexpr double kMostColumns = 2e8;
  cv::Rect columns;
  forEachNode(tree, [&](const SemanticOcTree::Node& node, const Cube& cube) {
    if (!(node.getLogOdds() > 0)) return false;
    const double voxel = tree.getResolution();
    const cv::Rect own = columnsUnder(cube.center(voxel).head<2>(), voxel * cube.edge(), voxel);
    if ((columns & own) == own) return false;
    if (node.isLeaf()) columns |= own;
    return true;
  });
  if (columns.empty()) throw std::runtime_error("nothing in the map is occupied");
  if (double(columns.width) * columns.height > kMostColumns)
    throw std::runtime_error("the map is too wide for a picture, " + std::to_string(columns.width) +
                             " x " + std::to_string(columns.height) +
                             " voxels: crop it, or make it coarser");
  return columns;
}

HighestCells highestLeaves(const SemanticOcTree& tree, const cv::Rect& columns, double maxHeight) {
  HighestCells highest(columns, tree.getResolution());
  forEachNode(tree, [&](const SemanticOcTree::Node& node, const Cube& cube) {
    if (!(node.getLogOdds() > 0)) return false;
    if (!node.isLeaf()) return true;
    const double voxel = tree.getResolution();
    const Eigen::Vector3d center = cube.center(voxel);
    if (center.z() <= maxHeight)
      highest.add(center, voxel * cube.edge(), tree.query(node).likeliestClass);
    return false;
  });
  return highest;
}

/** Pixels along a column's edge, so that a small map is no stamp. */
int enlargement(cv::Size columns) {
  constexpr int kGoodSize = 1000;
  return std::max(1, kGoodSize / std::max(columns.width, columns.height));
}

/** With paper below a low map, so that the legend needs one column only. */
cv::Mat enlarged(cv::Mat map, int scale, std::size_t legendEntries) {
  if (scale > 1) cv::resize(map, map, {}, scale, scale, cv::INTER_NEAREST);
  const int missing = legendHeight(legendEntries) - map.rows;
  if (missing > 0) cv::copyMakeBorder(map, map, 0, missing, 0, 0, cv::BORDER_CONSTANT, bgr(kPaper));
  return map;
}

}  // namespace

std::string ClassMap::worldFile() const {
  const cv::Point2d center = upperLeft + cv::Point2d(metersPerPixel, -metersPerPixel) / 2;
  std::ostringstream text;
  text << std::setprecision(12);
  for (const double value : {metersPerPixel, 0.0, 0.0, -metersPerPixel, center.x, center.y})
    text << value << '\n';
  return text.str();
}

ClassMap classMapOf(const SemanticOcTree& tree, const std::optional<double>& maxHeight) {
  const cv::Rect columns = occupiedColumns(tree);
  const double top = maxHeight ? *maxHeight : collectCells(tree, {}).maxHeight;
  std::vector<LegendEntry> legend;
  cv::Mat map;
  {  // two such pictures are not in memory beside the heights: there may be 10^8 columns
    const HighestCells highest = highestLeaves(tree, columns, top);
    legend = classLegend(tree.classes(), highest.countClasses(tree.numClasses()));
    map = highest.inColors(tree.classes());
  }
  const int scale = enlargement(columns.size());
  map = enlarged(std::move(map), scale, legend.size());
  const double edge = tree.getResolution();
  return {withLegend(map, "", legend), edge / scale, {columns.x * edge, columns.br().y * edge}};
}

}  // namespace map_pictures
