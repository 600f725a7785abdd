#include "MapSheet.h"

#include <algorithm>
#include <cmath>

namespace semantic_map_compress {

using map_pictures::bgr;
using map_pictures::kPaper;
using map_pictures::MapCanvas;
using semantic_octree::SemanticOcTree;

namespace {

constexpr int kSheetWidth = 2100;

cv::Mat onPaper(const cv::Mat& picture, cv::Size size) {
  cv::Mat paper(size, CV_8UC3, bgr(kPaper));
  const cv::Point corner((size.width - picture.cols) / 2, (size.height - picture.rows) / 2);
  picture.copyTo(paper(cv::Rect(corner, picture.size())));
  return paper;
}

}  // namespace

MapSheet::MapSheet(std::size_t numMaps)
    : m_columns(std::max(1, static_cast<int>(std::ceil(std::sqrt(double(numMaps)))))) {
  const int width = std::max(240, std::min(900, kSheetWidth / m_columns));
  m_tile = {width, width * 3 / 4};
}

void MapSheet::add(const SemanticOcTree& map, const std::string& title) {
  map_pictures::PictureStyle style;
  style.width = m_tile.width, style.height = m_tile.height;
  auto canvas = m_first ? m_first->blank() : MapCanvas::ofMap(map, style);
  if (m_first) canvas.drawMap(map, style);
  for (const auto& entry : canvas.legend()) explain(entry);
  cv::Mat picture = canvas.picture().clone();
  map_pictures::drawScaleBar(picture, canvas.pixelsPerMeter());
  if (!m_first) m_first = std::move(canvas);
  m_tiles.push_back(map_pictures::withTitle(onPaper(picture, m_tile), title));
}

void MapSheet::explain(const map_pictures::LegendEntry& entry) {
  const auto hasName = [&entry](const auto& other) { return other.name == entry.name; };
  if (std::none_of(m_legend.begin(), m_legend.end(), hasName)) m_legend.push_back(entry);
}

cv::Mat MapSheet::picture() const {
  std::vector<cv::Mat> rows;
  const int numTiles = static_cast<int>(m_tiles.size());
  for (int first = 0; first < numTiles; first += m_columns) {
    std::vector<cv::Mat> row(m_tiles.begin() + first,
                             m_tiles.begin() + std::min(first + m_columns, numTiles));
    while (static_cast<int>(row.size()) < m_columns && first > 0)
      row.emplace_back(m_tiles.front().size(), CV_8UC3, bgr(kPaper));
    cv::hconcat(row, rows.emplace_back());
  }
  cv::Mat maps;
  cv::vconcat(rows, maps);
  return withLegend(maps, "", m_legend);
}

}  // namespace semantic_map_compress
