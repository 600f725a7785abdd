#include "ExportGround.h"

#include <semantic_octree/ColumnScan.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace semantic_map {

using semantic_octree::SemanticOcTree;
using semantic_types::ClassId;

namespace {

constexpr float kNowhere = std::numeric_limits<float>::max();

/** Height below which a column has nothing but ghosts (see ColumnTile), m. */
cv::Mat floorsOf(const SemanticOcTree& tree, const ExportColumns& columns, double low) {
  using semantic_octree::Column;
  const semantic_octree::ColumnScanner scanner(tree);
  const int margin = int(low / columns.resolution());
  cv::Mat floors(columns.size(), CV_32F);
  const Column first = semantic_octree::tileOf(columns.columnAt(floors.rows - 1, 0));
  const Column last = semantic_octree::tileOf(columns.columnAt(0, floors.cols - 1));
  const Column upperLeft = columns.columnAt(0, 0);
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x) {
      const auto tile = scanner.scan({x, y});
      const Column corner = semantic_octree::firstColumnOf({x, y});
      for (int i = 0; i < semantic_octree::kTileColumns; ++i) {
        const cv::Point pixel(corner.x + i % semantic_octree::kTileEdge - upperLeft.x,
                              upperLeft.y - corner.y - i / semantic_octree::kTileEdge);
        if (pixel.inside({{0, 0}, floors.size()}))
          floors.at<float>(pixel) =
              float(semantic_octree::lowerBorderOf(tile.floorOf(i, margin), columns.resolution()));
      }
    }
  return floors;
}

/** The lowest leaf of each column that may be ground. */
struct LowestLeaves {
  cv::Mat floor, height, logOdds;

  /** \param floors what is below them does not count */
  explicit LowestLeaves(const cv::Mat& floors)
      : floor(floors),
        height(floors.size(), CV_32F, cv::Scalar(kNowhere)),
        logOdds(floors.size(), CV_32F, cv::Scalar(0)) {}

  void add(const cv::Rect& columns, float z, float leafLogOdds) {
    const cv::Mat higher = (height(columns) > z) & (floor(columns) < z);
    height(columns).setTo(z, higher);
    logOdds(columns).setTo(leafLogOdds, higher);
  }
};

LowestLeaves lowestLeaves(const SemanticOcTree& tree, const ExportColumns& columns,
                          const GridOptions& options) {
  LowestLeaves lowest(floorsOf(tree, columns, options.low));
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
    if (isOccupiedBy(options.ground, tree, *leaf))
      lowest.add(columns.under(leaf),
                 float(leaf.getZ() + (leaf.getSize() - columns.resolution()) / 2),
                 leaf->getLogOdds());
  return lowest;
}

/** Opening: what is narrower than the window and stands out of its surroundings is gone; holes that
 * are narrower are filled. */
cv::Mat opened(const cv::Mat& height, int window) {
  const cv::Mat square = cv::Mat::ones(window, window, CV_8U);
  cv::Mat low, surface;
  cv::erode(height, low, square, {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(kNowhere));
  low.setTo(-kNowhere, low == kNowhere);
  cv::dilate(low, surface, square, {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(-kNowhere));
  surface.setTo(std::nanf(""), surface == -kNowhere);
  return surface;
}

}  // namespace

bool isOccupiedBy(const std::vector<ClassId>& classes, const SemanticOcTree& tree,
                  const SemanticOcTree::Node& leaf) {
  if (leaf.getLogOdds() <= 0) return false;
  if (classes.empty()) return true;
  return std::count(classes.begin(), classes.end(), tree.query(leaf).likeliestClass) > 0;
}

ExportGround groundOf(const SemanticOcTree& tree, const ExportColumns& columns,
                      const GridOptions& options) {
  if (options.floor)
    return {cv::Mat(columns.size(), CV_32F, cv::Scalar(*options.floor)),
            cv::Mat(columns.size(), CV_32F, cv::Scalar(0))};
  LowestLeaves lowest = lowestLeaves(tree, columns, options);
  // What stands out of its surroundings is no ground: the surface is opened (morphologically) by a
  // square that is wider than cars and narrower than hills.
  constexpr double kWindow = 4;  // m
  const int window = 2 * int(std::lround(kWindow / columns.resolution() / 2)) + 1;
  const cv::Mat height = opened(lowest.height, window);
  lowest.logOdds.setTo(0, lowest.height > height + options.low);
  return {height, lowest.logOdds};
}

}  // namespace semantic_map
