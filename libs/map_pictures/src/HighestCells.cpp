#include "HighestCells.h"

#include <map_pictures/MapCanvas.h>

#include <cmath>

#include "Hatching.h"
#include "Relief.h"

namespace map_pictures {

namespace {

/** Cells of that many columns are coarse; and a hatch has a stripe every so many columns. */
constexpr int kCoarse = 4, kStripes = 4;

}  // namespace

cv::Rect columnsUnder(const Eigen::Vector2d& center, double size, double edge) {
  const int width = std::max(1, int(std::lround(size / edge)));
  return {int(std::lround((center.x() - size / 2) / edge)),
          int(std::lround((center.y() - size / 2) / edge)), width, width};
}

HighestCells::HighestCells(const cv::Rect& columns, double edge)
    : m_columns(columns),
      m_edge(edge),
      m_height(columns.size(), CV_32F, cv::Scalar(NAN)),
      m_classId(columns.size(), CV_8U, cv::Scalar(0)),
      m_coarse(columns.size(), CV_8U, cv::Scalar(0)) {}

void HighestCells::add(const Eigen::Vector3d& center, double size, semantic_types::ClassId id) {
  const cv::Rect covered = columnsUnder(center.head<2>(), size, m_edge);
  const cv::Rect seen = covered & m_columns;
  const float top = float(center.z() + size / 2);
  for (int y = seen.y; y < seen.br().y; ++y)
    for (int x = seen.x; x < seen.br().x; ++x) {
      const cv::Point pixel(x - m_columns.x, m_columns.br().y - 1 - y);
      float& height = m_height.at<float>(pixel);
      if (height >= top) continue;
      height = top;
      m_classId.at<std::uint8_t>(pixel) = id;
      m_coarse.at<std::uint8_t>(pixel) = covered.width >= kCoarse;
    }
}

std::vector<std::size_t> HighestCells::countClasses(int numClasses) const {
  std::vector<std::size_t> counts(numClasses + 1, 0);
  const cv::Mat known = m_height == m_height;
  for (int id = 0; id <= numClasses; ++id)
    counts[id] = std::size_t(cv::countNonZero((m_classId == id) & known));
  return counts;
}

cv::Mat HighestCells::inColors(const semantic_types::ClassTable& classes) const {
  cv::Mat_<cv::Vec3b> picture(m_height.size());
  for (int row = 0; row < picture.rows; ++row)
    for (int col = 0; col < picture.cols; ++col) {
      const auto color = std::isnan(m_height.at<float>(row, col))
                             ? kPaper
                             : colorOf(m_classId.at<std::uint8_t>(row, col), classes);
      picture(row, col) = {color.b, color.g, color.r};
    }
  return picture;
}

cv::Mat HighestCells::inRelief(const semantic_types::ClassTable& classes) const {
  cv::Mat_<cv::Vec3b> picture = inColors(classes);
  for (int row = 0; row < picture.rows; ++row)
    for (int col = 0; col < picture.cols; ++col)
      if (m_coarse.at<std::uint8_t>(row, col))
        picture(row, col) = hatched(picture(row, col), col, row, kStripes);
  shadeByRelief(picture, m_height, m_edge);
  return picture;
}

}  // namespace map_pictures
