#include "GifPalette.h"

#include <algorithm>
#include <cmath>

namespace map_pictures {
namespace {

constexpr std::size_t kMostColors = 63;

/** Pixels of nearly one color. */
struct Cell {
  int index = 0, count = 0;
  cv::Vec3d sum;

  double mean(int channel) const { return sum[channel] / count; }
};

using Cells = std::vector<Cell>;

/** Some of the cells, for which one color will stand. */
struct Box {
  Cells::iterator begin, end;
  int channel = 0;    ///< in which they differ most
  double spread = 0;  ///< how much, times the root of the number of pixels

  Box(Cells::iterator first, Cells::iterator last) : begin(first), end(last) {
    double count = 0;
    for (auto cell = begin; cell != end; ++cell) count += cell->count;
    for (int c = 0; c < 3; ++c) {
      const auto [low, high] = std::minmax_element(
          begin, end, [c](const Cell& a, const Cell& b) { return a.mean(c) < b.mean(c); });
      const double range = (high->mean(c) - low->mean(c)) * std::sqrt(count);
      if (range > spread) spread = range, channel = c;
    }
  }

  /** Where half of the pixels are on each side; both sides have cells. */
  Cells::iterator median() const {
    const int c = channel;
    std::sort(begin, end, [c](const Cell& a, const Cell& b) { return a.mean(c) < b.mean(c); });
    double count = 0, before = 0;
    for (auto cell = begin; cell != end; ++cell) count += cell->count;
    auto middle = begin;
    while (middle != end - 1 && before + middle->count <= count / 2) before += (middle++)->count;
    return std::max(middle, begin + 1);
  }
};

std::vector<Box> boxesOf(Cells& cells) {
  if (cells.empty()) return {};
  std::vector<Box> boxes = {Box(cells.begin(), cells.end())};
  while (boxes.size() < kMostColors) {
    const auto widest = std::max_element(
        boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a.spread < b.spread; });
    if (widest->spread <= 0) break;
    const auto middle = widest->median();
    const Box upper(middle, widest->end);
    *widest = Box(widest->begin, middle);
    boxes.push_back(upper);
  }
  return boxes;
}

cv::Vec3b meanOf(const Box& box) {
  cv::Vec3d sum;
  double count = 0;
  for (auto cell = box.begin; cell != box.end; ++cell) sum += cell->sum, count += cell->count;
  return sum / count;
}

}  // namespace

GifPalette::GifPalette(const cv::Mat& picture, const cv::Mat& mask) : m_index(1 << 15, 0) {
  std::vector<Cell> all(1 << 15);
  for (int row = 0; row < picture.rows; ++row)
    for (int col = 0; col < picture.cols; ++col) {
      if (!mask.at<std::uint8_t>(row, col)) continue;
      const auto& color = picture.at<cv::Vec3b>(row, col);
      Cell& cell = all[cellOf(color)];
      cell.index = cellOf(color);
      cell.sum += cv::Vec3d(color), ++cell.count;
    }
  Cells cells;
  std::copy_if(all.begin(), all.end(), std::back_inserter(cells),
               [](const Cell& cell) { return cell.count > 0; });
  for (const Box& box : boxesOf(cells)) {
    for (auto cell = box.begin; cell != box.end; ++cell)
      m_index[cell->index] = std::uint8_t(m_colors.size());
    m_colors.push_back(meanOf(box));
  }
}

}  // namespace map_pictures
