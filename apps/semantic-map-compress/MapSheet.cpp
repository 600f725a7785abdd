#include "MapSheet.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace semantic_map_compress {

using semantic_octree::SemanticOcTree;

namespace {

const cv::Scalar kPaper(250, 250, 250), kInk(50, 45, 40);
constexpr int kTitleHeight = 34;
constexpr int kSheetWidth = 2100;

cv::Mat onPaper(const cv::Mat& picture, cv::Size size) {
  cv::Mat paper(size, CV_8UC3, kPaper);
  const cv::Point corner((size.width - picture.cols) / 2, (size.height - picture.rows) / 2);
  picture.copyTo(paper(cv::Rect(corner, picture.size())));
  return paper;
}

semantic_map::PictureStyle styleOf(cv::Size size) {
  semantic_map::PictureStyle style;
  style.width = size.width;
  style.height = size.height;
  style.legend = false;
  return style;
}

/** The rows from the top to the last that is not empty. */
cv::Mat withoutEmptyEnd(const cv::Mat& picture) {
  cv::Mat empty;
  cv::inRange(picture, kPaper, kPaper, empty);
  const int rows = cv::boundingRect(empty == 0).br().y;
  return picture.rowRange(0, std::max(1, rows)).clone();
}

/** The part of a picture to the right of the map. */
cv::Mat legendOf(const SemanticOcTree& map) {
  auto style = styleOf({1600, 1600});
  const int mapWidth = topView(map, style).cols;
  style.legend = true;
  const cv::Mat whole = topView(map, style);
  return withoutEmptyEnd(whole.colRange(mapWidth, whole.cols));
}

}  // namespace

cv::Mat topView(const SemanticOcTree& map, const semantic_map::PictureStyle& style) {
  constexpr double kMostColumns = 1e8;  // of voxels, which the renderer holds in memory
  double lowX, lowY, lowZ, highX, highY, highZ;
  map.getMetricMin(lowX, lowY, lowZ);
  map.getMetricMax(highX, highY, highZ);
  const double area = (highX - lowX) * (highY - lowY), voxel = map.getResolution();
  if (area > kMostColumns * voxel * voxel)
    return cv::Mat(style.height, style.width, CV_8UC3, kPaper);
  return renderTopView(map, style);
}

MapSheet::MapSheet(std::size_t numMaps)
    : m_columns(std::max(1, static_cast<int>(std::ceil(std::sqrt(double(numMaps)))))) {
  const int width = std::max(240, std::min(900, kSheetWidth / m_columns));
  m_tile = {width, width * 3 / 4};
}

void MapSheet::add(const SemanticOcTree& map, const std::string& title) {
  if (m_tiles.empty()) m_legend = legendOf(map);
  cv::Mat tile;
  cv::copyMakeBorder(onPaper(topView(map, styleOf(m_tile)), m_tile), tile, kTitleHeight, 0, 0, 0,
                     cv::BORDER_CONSTANT, kPaper);
  cv::putText(tile, title, {24, kTitleHeight - 10}, cv::FONT_HERSHEY_DUPLEX, 0.6, kInk, 1,
              cv::LINE_AA);
  m_tiles.push_back(tile);
}

cv::Mat MapSheet::picture() const {
  std::vector<cv::Mat> rows;
  const int numTiles = static_cast<int>(m_tiles.size());
  for (int first = 0; first < numTiles; first += m_columns) {
    std::vector<cv::Mat> row(m_tiles.begin() + first,
                             m_tiles.begin() + std::min(first + m_columns, numTiles));
    while (static_cast<int>(row.size()) < m_columns && first > 0)
      row.emplace_back(m_tiles.front().size(), CV_8UC3, kPaper);
    cv::hconcat(row, rows.emplace_back());
  }
  cv::Mat maps, sheet;
  cv::vconcat(rows, maps);
  const int height = std::max(maps.rows, m_legend.rows);
  cv::Mat left(height, maps.cols, CV_8UC3, kPaper), right(height, m_legend.cols, CV_8UC3, kPaper);
  maps.copyTo(left(cv::Rect({0, 0}, maps.size())));
  m_legend.copyTo(right(cv::Rect({0, 0}, m_legend.size())));
  cv::hconcat(left, right, sheet);
  return sheet;
}

}  // namespace semantic_map_compress
