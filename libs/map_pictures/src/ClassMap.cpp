#include <map_pictures/MapCanvas.h>
#include <map_pictures/MapPictures.h>
#include <strict_files/TextFile.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iomanip>
#include <opencv2/imgcodecs.hpp>
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

std::vector<std::uint8_t> encoded(const cv::Mat& rows) {
  std::vector<std::uint8_t> png;
  if (!cv::imencode(".png", rows, png)) throw std::runtime_error("a picture cannot be encoded");
  return png;
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

}  // namespace

ClassMap::ClassMap(const SemanticOcTree& tree, const std::optional<double>& maxHeight,
                   int columnsAtOnce) {
  const cv::Rect columns = occupiedColumns(tree);
  const double top = maxHeight ? *maxHeight : collectCells(tree, {}).maxHeight;
  std::vector<std::size_t> counts(tree.numClasses() + 1, 0);
  for (const cv::Rect& band : bandsOf(columns, columnsAtOnce)) {
    const HighestCells highest = highestLeaves(tree, band, top);
    const auto inBand = highest.countClasses(tree.numClasses());
    std::transform(counts.begin(), counts.end(), inBand.begin(), counts.begin(), std::plus<>());
    m_bands.push_back(encoded(highest.inColors(tree.classes())));
  }
  m_scale = enlargement(columns.size());
  m_width = m_scale * columns.width;
  m_legend = legendBeside(m_scale * columns.height, classLegend(tree.classes(), counts));
  const double edge = tree.getResolution();
  m_metersPerPixel = edge / m_scale;
  m_upperLeft = {columns.x * edge, columns.br().y * edge};
}

cv::Size ClassMap::size() const { return {m_width + m_legend.cols, m_legend.rows}; }

std::string ClassMap::worldFile() const {
  const cv::Point2d center = m_upperLeft + cv::Point2d(m_metersPerPixel, -m_metersPerPixel) / 2;
  std::ostringstream text;
  const strict_files::ClassicNumbers classic(text);
  text << std::setprecision(12);
  for (const double value : {m_metersPerPixel, 0.0, 0.0, -m_metersPerPixel, center.x, center.y})
    text << value << '\n';
  return text.str();
}

void ClassMap::forEachBand(const std::function<void(const cv::Mat& rows)>& take) const {
  int done = 0;
  const auto takeWithLegend = [&](const cv::Mat& map) {
    cv::Mat rows;
    cv::hconcat(map, m_legend.rowRange(done, done + map.rows), rows);
    done += map.rows;
    take(rows);
  };
  for (const std::vector<std::uint8_t>& band : m_bands) {
    cv::Mat map = cv::imdecode(band, cv::IMREAD_COLOR);
    if (m_scale > 1) cv::resize(map, map, {}, m_scale, m_scale, cv::INTER_NEAREST);
    takeWithLegend(map);
  }
  if (done < m_legend.rows)
    takeWithLegend(cv::Mat(m_legend.rows - done, m_width, CV_8UC3, bgr(kPaper)));
}

cv::Mat ClassMap::picture() const {
  cv::Mat picture(size(), CV_8UC3);
  int done = 0;
  forEachBand([&](const cv::Mat& rows) {
    rows.copyTo(picture.rowRange(done, done + rows.rows));
    done += rows.rows;
  });
  return picture;
}

}  // namespace map_pictures
