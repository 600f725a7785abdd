#include <cmath>
#include <opencv2/imgproc.hpp>

#include "CellColors.h"
#include "MapCells.h"
#include "PictureSheet.h"
#include "Relief.h"

namespace semantic_map {

using semantic_octree::SemanticOcTree;

namespace {

/** The highest cell of each column: image row 0 is the largest y. */
struct ColumnImage {
  cv::Mat height;  ///< 32 bit float, m; NaN where a column holds nothing
  cv::Mat color;   ///< BGR
  double cell;     ///< m per pixel
};

ColumnImage emptyColumns(const Extent& extent, double cell) {
  ColumnImage columns;
  columns.cell = cell;
  const Eigen::Vector3f size = (extent.high - extent.low) / float(cell);
  const cv::Size pixels(std::max(1, int(std::lround(size.x()))),
                        std::max(1, int(std::lround(size.y()))));
  columns.height = cv::Mat(pixels, CV_32F, cv::Scalar(NAN));
  columns.color = cv::Mat(pixels, CV_8UC3, kPaper);
  return columns;
}

/** The columns that a cell covers; a cell may be many columns wide, and partly outside. */
cv::Rect footprint(const MapCell& cell, const Extent& extent, const ColumnImage& columns) {
  const double half = cell.size / 2;
  const int left = int(std::lround((cell.center.x() - half - extent.low.x()) / columns.cell));
  const int top = int(std::lround((extent.high.y() - cell.center.y() - half) / columns.cell));
  const int size = std::max(1, int(std::lround(cell.size / columns.cell)));
  return cv::Rect(left, top, size, size) & cv::Rect({0, 0}, columns.height.size());
}

ColumnImage columnsOf(const SemanticOcTree& tree, const MapCells& map, const Extent& extent) {
  ColumnImage columns = emptyColumns(extent, tree.getNodeSize(map.depth));
  for (const MapCell& cell : map.cells) {
    const cv::Rect area = footprint(cell, extent, columns);
    const auto color = classColor(tree.classes(), cell.id);
    const float top = cell.center.z() + cell.size / 2;
    for (int row = area.y; row < area.br().y; ++row)
      for (int col = area.x; col < area.br().x; ++col) {
        float& height = columns.height.at<float>(row, col);
        if (height >= top) continue;
        height = top;
        columns.color.at<cv::Vec3b>(row, col) = {color.b, color.g, color.r};
      }
  }
  return columns;
}

/** Sharp columns if they are larger than pixels, their mean if they are smaller. */
cv::Mat scaledBy(const cv::Mat& image, double scale) {
  const cv::Size target(std::max(1, int(std::lround(image.cols * scale))),
                        std::max(1, int(std::lround(image.rows * scale))));
  const int enlarge = std::max(1, int(std::ceil(scale)));
  cv::Mat large, out;
  cv::resize(image, large, {}, enlarge, enlarge, cv::INTER_NEAREST);
  cv::resize(large, out, target, 0, 0, cv::INTER_AREA);
  return out;
}

/** The middle of the paper, with a margin. */
cv::Mat onPaper(const cv::Mat& map, int margin) {
  cv::Mat paper;
  cv::copyMakeBorder(map, paper, margin, margin, margin, margin, cv::BORDER_CONSTANT, kPaper);
  return paper;
}

}  // namespace

cv::Mat renderTopView(const SemanticOcTree& tree, const PictureStyle& style) {
  style.validate();
  const MapCells map = collectCells(tree, style);
  if (map.cells.empty()) return cv::Mat(style.height, style.width, CV_8UC3, kPaper);

  ColumnImage columns = columnsOf(tree, map, extentOf(map.cells));
  shadeByRelief(columns.color, columns.height, columns.cell);
  constexpr int kBorder = 24;
  const double scale = std::min(double(style.width - 2 * kBorder) / columns.color.cols,
                                double(style.height - 2 * kBorder) / columns.color.rows);
  cv::Mat picture = onPaper(scaledBy(columns.color, scale), kBorder);
  drawAxes(picture, {cv::Point2d(1, 0), cv::Point2d(0, -1), cv::Point2d(0, 0)});
  drawScaleBar(picture, scale / columns.cell);
  if (!style.legend) return picture;
  return withLegend(picture, style.title,
                    legendOf(tree.classes(), map.countClasses(tree.numClasses())));
}

}  // namespace semantic_map
