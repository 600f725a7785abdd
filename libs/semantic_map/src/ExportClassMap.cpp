#include <semantic_map/ExportClassMap.h>

#include <algorithm>
#include <iomanip>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "CellColors.h"
#include "ExportColumns.h"
#include "MapCells.h"
#include "PictureSheet.h"

namespace semantic_map {

using semantic_octree::SemanticOcTree;
using semantic_types::ClassId;

namespace {

/** The highest occupied leaf of each column. */
struct HighestLeaves {
  cv::Mat height;   ///< upper side, m, 32 bit float; -infinity: there is none
  cv::Mat classId;  ///< likeliest class, 8 bit

  explicit HighestLeaves(cv::Size size)
      : height(size, CV_32F, cv::Scalar(-std::numeric_limits<float>::infinity())),
        classId(size, CV_8U, cv::Scalar(0)) {}

  void add(const cv::Rect& columns, float top, ClassId id) {
    const cv::Mat lower = height(columns) < top;
    height(columns).setTo(top, lower);
    classId(columns).setTo(id, lower);
  }
};

HighestLeaves highestLeaves(const SemanticOcTree& tree, const ExportColumns& columns,
                            double maxHeight) {
  HighestLeaves highest(columns.size());
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
    if (leaf->getLogOdds() > 0 && leaf.getZ() <= maxHeight)
      highest.add(columns.under(leaf), float(leaf.getZ() + leaf.getSize() / 2),
                  tree.query(*leaf).likeliestClass);
  return highest;
}

cv::Mat paint(const HighestLeaves& highest, const semantic_types::ClassTable& classes) {
  cv::Mat_<cv::Vec3b> picture(highest.height.size());
  for (int row = 0; row < picture.rows; ++row)
    for (int col = 0; col < picture.cols; ++col) {
      const auto c = classColor(classes, highest.classId.at<std::uint8_t>(row, col));
      picture(row, col) = {c.b, c.g, c.r};
    }
  picture.setTo(kPaper, highest.height == -std::numeric_limits<float>::infinity());
  return std::move(picture);
}

std::vector<std::size_t> countClasses(const HighestLeaves& highest, int numClasses) {
  std::vector<std::size_t> counts(numClasses + 1, 0);
  const cv::Mat known = highest.height > -std::numeric_limits<float>::infinity();
  for (int id = 0; id <= numClasses; ++id)
    counts[id] = std::size_t(cv::countNonZero((highest.classId == id) & known));
  return counts;
}

/** Pixels along a column's edge, so that a small map is no stamp. */
int enlargement(cv::Size columns) {
  constexpr int kGoodSize = 1000;
  return std::max(1, kGoodSize / std::max(columns.width, columns.height));
}

/** Paper below a low map, so that the legend need not leave classes out. */
cv::Mat withRoomFor(std::size_t legendEntries, const cv::Mat& map) {
  constexpr int kRow = 28, kMargins = 40;
  const int missing = std::max(0, int(legendEntries) * kRow + kMargins - map.rows);
  cv::Mat sheet;
  cv::copyMakeBorder(map, sheet, 0, missing, 0, 0, cv::BORDER_CONSTANT, kPaper);
  return sheet;
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
  const ExportColumns columns(tree, true);
  const double top = maxHeight ? *maxHeight : collectCells(tree, {}).maxHeight;
  const HighestLeaves highest = highestLeaves(tree, columns, top);
  const int scale = enlargement(columns.size());
  cv::Mat map;
  cv::resize(paint(highest, tree.classes()), map, {}, scale, scale, cv::INTER_NEAREST);
  const auto legend = legendOf(tree.classes(), countClasses(highest, tree.numClasses()));
  return {withLegend(withRoomFor(legend.size(), map), "", legend), columns.resolution() / scale,
          columns.upperLeft()};
}

}  // namespace semantic_map
