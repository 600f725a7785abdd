#include "ExportGround.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace semantic_map {

using semantic_octree::SemanticOcTree;
using semantic_types::ClassId;

namespace {

constexpr float kNowhere = std::numeric_limits<float>::max();

/** The lowest leaf of each column that may be ground. */
struct LowestLeaves {
  cv::Mat height, logOdds;

  explicit LowestLeaves(cv::Size size)
      : height(size, CV_32F, cv::Scalar(kNowhere)), logOdds(size, CV_32F, cv::Scalar(0)) {}

  void add(const cv::Rect& columns, float z, float leafLogOdds) {
    const cv::Mat higher = height(columns) > z;
    height(columns).setTo(z, higher);
    logOdds(columns).setTo(leafLogOdds, higher);
  }
};

LowestLeaves lowestLeaves(const SemanticOcTree& tree, const ExportColumns& columns,
                          const std::vector<ClassId>& classes) {
  LowestLeaves lowest(columns.size());
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
    if (isOccupiedBy(classes, tree, *leaf))
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
  LowestLeaves lowest = lowestLeaves(tree, columns, options.ground);
  const int window = 2 * int(std::lround(options.window / columns.resolution() / 2)) + 1;
  const cv::Mat height = opened(lowest.height, window);
  lowest.logOdds.setTo(0, lowest.height > height + options.low);
  return {height, lowest.logOdds};
}

}  // namespace semantic_map
