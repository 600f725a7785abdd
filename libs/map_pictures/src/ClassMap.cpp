#include <map_pictures/MapCanvas.h>
#include <map_pictures/MapPictures.h>
#include <strict_files/TextFile.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iomanip>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <stdexcept>

#include "MapCells.h"

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
  const double voxel = tree.getResolution();
  HighestCells highest(columns, voxel);
  forEachNode(tree, [&](const SemanticOcTree::Node& node, const Cube& cube) {
    if (!(node.getLogOdds() > 0)) return false;
    const Eigen::Vector3d center = cube.center(voxel);
    const double size = voxel * cube.edge();
    if ((columnsUnder(center.head<2>(), size, voxel) & columns).empty()) return false;
    if (!node.isLeaf()) return true;
    if (center.z() <= maxHeight) highest.add(center, size, tree.query(node).likeliestClass);
    return false;
  });
  return highest;
}

/** From top to bottom. They end where tiles do, which so are in one band only, unless there is room
 * for less than a row of tiles. */
std::vector<cv::Rect> bandsOf(const cv::Rect& columns, int columnsAtOnce) {
  int height = 1;
  while (height < columns.height && 2.0 * height * columns.width <= columnsAtOnce) height *= 2;
  std::vector<cv::Rect> bands;
  for (int top = columns.br().y; top > columns.y; top = bands.back().y) {
    const int low = height * int(std::floor(double(top - 1) / height));
    bands.emplace_back(cv::Point(columns.x, std::max(low, columns.y)),
                       cv::Point(columns.br().x, top));
  }
  return bands;
}

/** Pixels along a column's edge, so that a small map is no stamp. */
int enlargement(cv::Size columns) {
  constexpr int kGoodSize = 1000;
  return std::max(1, kGoodSize / std::max(columns.width, columns.height));
}

/** What stands to the right of a map of that height; higher than a low one, so that one column is
 * enough. */
cv::Mat legendBeside(int rows, const std::vector<LegendEntry>& entries) {
  const cv::Mat map(std::max(rows, legendHeight(entries.size())), 1, CV_8UC3, bgr(kPaper));
  const cv::Mat sheet = withLegend(map, "", entries);
  return sheet.colRange(1, sheet.cols).clone();
}

/** \param upperLeft outer corner of pixel (0, 0), m, map frame */
std::string worldFileOf(double metersPerPixel, const cv::Point2d& upperLeft) {
  const cv::Point2d center = upperLeft + cv::Point2d(metersPerPixel, -metersPerPixel) / 2;
  std::ostringstream text;
  const strict_files::ClassicNumbers classic(text);
  text << std::setprecision(12);
  for (const double value : {metersPerPixel, 0.0, 0.0, -metersPerPixel, center.x, center.y})
    text << value << '\n';
  return text.str();
}

}  // namespace

ClassMap drawClassMap(const SemanticOcTree& tree, const std::optional<double>& maxHeight,
                      int columnsAtOnce) {
  const cv::Rect columns = occupiedColumns(tree);
  const double top = maxHeight ? *maxHeight : collectCells(tree, {}).maxHeight;
  std::vector<std::size_t> counts(tree.numClasses() + 1, 0);
  cv::Mat map;
  for (const cv::Rect& band : bandsOf(columns, columnsAtOnce)) {
    const HighestCells highest = highestLeaves(tree, band, top);
    const auto inBand = highest.countClasses(tree.numClasses());
    std::transform(counts.begin(), counts.end(), inBand.begin(), counts.begin(), std::plus<>());
    const cv::Mat rows = highest.inColors(tree.classes());
    if (map.empty()) map.create(columns.size(), rows.type());
    rows.copyTo(map.rowRange(columns.br().y - band.br().y, columns.br().y - band.y));
  }
  const int scale = enlargement(columns.size());
  if (scale > 1) cv::resize(map, map, {}, scale, scale, cv::INTER_NEAREST);
  const cv::Mat legend = legendBeside(map.rows, classLegend(tree.classes(), counts));
  ClassMap drawn;
  cv::copyMakeBorder(map, drawn.picture, 0, legend.rows - map.rows, 0, legend.cols,
                     cv::BORDER_CONSTANT, bgr(kPaper));
  legend.copyTo(drawn.picture.colRange(map.cols, drawn.picture.cols));
  const double edge = tree.getResolution();
  drawn.worldFile = worldFileOf(edge / scale, {columns.x * edge, columns.br().y * edge});
  return drawn;
}

}  // namespace map_pictures
