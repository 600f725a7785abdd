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

/** Edge of a column, m: that of the finest cells, or larger if there would be more columns than
 * memory is for. (One cell may be kilometers wide: a collapsed root.) */
double columnSize(const Extent& extent, double finest) {
  constexpr double kMostColumns = 16e6;
  const Eigen::Vector2d size = (extent.high - extent.low).head<2>().cast<double>();
  double cell = finest;
  while (size.x() / cell * (size.y() / cell) > kMostColumns) cell *= 2;
  return cell;
}

ColumnImage columnsOf(const SemanticOcTree& tree, const MapCells& map, const Extent& extent) {
  ColumnImage columns = emptyColumns(extent, columnSize(extent, tree.getNodeSize(map.depth)));
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

TopView takeTopView(const SemanticOcTree& tree, const PictureStyle& style) {
  style.validate();
  TopView view;
  const MapCells map = collectCells(tree, style);
  if (map.cells.empty()) {
    view.picture = cv::Mat(style.height, style.width, CV_8UC3, kPaper);
    return view;
  }
  const Extent extent = extentOf(map.cells);
  ColumnImage columns = columnsOf(tree, map, extent);
  shadeByRelief(columns.color, columns.height, columns.cell);
  constexpr int kBorder = 24;
  const double scale = std::min(double(style.width - 2 * kBorder) / columns.color.cols,
                                double(style.height - 2 * kBorder) / columns.color.rows);
  view.pixelsPerMeter = scale / columns.cell;
  view.origin = {kBorder - extent.low.x() * view.pixelsPerMeter,
                 kBorder + extent.high.y() * view.pixelsPerMeter};
  view.picture = onPaper(scaledBy(columns.color, scale), kBorder);
  drawAxes(view.picture, {cv::Point2d(1, 0), cv::Point2d(0, -1), cv::Point2d(0, 0)});
  drawScaleBar(view.picture, view.pixelsPerMeter);
  if (style.legend)
    view.picture = withLegend(view.picture, style.title,
                              legendOf(tree.classes(), map.countClasses(tree.numClasses())));
  return view;
}

cv::Mat renderTopView(const SemanticOcTree& tree, const PictureStyle& style) {
  return takeTopView(tree, style).picture;
}

}  // namespace semantic_map
