#include "HighestCells.h"

#include <map_pictures/MapCanvas.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace map_pictures {
namespace {

/** Means around each pixel. */
cv::Mat averaged(const cv::Mat& values, int radius) {
  cv::Mat mean;
  cv::boxFilter(values, mean, CV_32F, cv::Size(2 * radius + 1, 2 * radius + 1));
  return mean;
}

/** The heights, and 0 where nothing is known. */
cv::Mat knownHeights(const cv::Mat& height, const cv::Mat& known) {
  cv::Mat values = height.clone();
  values.setTo(0, ~known);
  return values;
}

/** 1 where something is known, else 0. */
cv::Mat weightOf(const cv::Mat& known) {
  cv::Mat weight;
  known.convertTo(weight, CV_32F, 1.0 / 255);
  return weight;
}

/** Mean of the known heights around each pixel. Maps may be large: as little as can be is in memory
 * at a time. */
cv::Mat meanAround(const cv::Mat& height, int radius) {
  const cv::Mat known = height == height;
  cv::Mat mean = averaged(knownHeights(height, known), radius);
  cv::Mat weight = averaged(weightOf(known), radius);
  cv::max(weight, 1e-6, weight);
  cv::divide(mean, weight, mean);
  return mean;
}

float heightAt(const cv::Mat& height, int row, int col, float otherwise) {
  row = std::clamp(row, 0, height.rows - 1), col = std::clamp(col, 0, height.cols - 1);
  const float h = height.at<float>(row, col);
  return std::isnan(h) ? otherwise : h;
}

/** Rise towards the lower right, of which the light from the upper left shows more. */
double slopeFromLight(const cv::Mat& height, int row, int col, double cell) {
  const float h = height.at<float>(row, col);
  return (heightAt(height, row + 1, col + 1, h) - heightAt(height, row - 1, col - 1, h)) /
         (2 * M_SQRT2 * cell);
}

cv::Vec3b shaded(const cv::Vec3b& color, double brightness) {
  cv::Vec3b out;
  for (int i = 0; i < 3; ++i) {
    const double c = brightness <= 1 ? color[i] * brightness
                                     : 255 - (255 - color[i]) * std::max(0.0, 2 - brightness);
    out[i] = cv::saturate_cast<std::uint8_t>(c);
  }
  return out;
}

/** Shades an image of columns by their heights, as maps do: lit from the upper left, and what
 * stands out of its surroundings brighter than what lies low. \param color BGR \param height 32 bit
 * float, m, NaN where there is nothing \param cell m */
void shadeByRelief(cv::Mat& color, const cv::Mat& height, double cell) {
  constexpr double kLight = 0.25, kProminence = 0.2;
  constexpr double kSurroundings = 2.0, kStep = 1.5;  // m
  const cv::Mat mean = meanAround(height, std::max(1, int(kSurroundings / cell)));
  for (int row = 0; row < height.rows; ++row)
    for (int col = 0; col < height.cols; ++col) {
      const float h = height.at<float>(row, col);
      if (std::isnan(h)) continue;
      const double light = kLight * std::tanh(slopeFromLight(height, row, col, cell));
      const double prominence = kProminence * std::tanh((h - mean.at<float>(row, col)) / kStep);
      auto& c = color.at<cv::Vec3b>(row, col);
      c = shaded(c, 1 + light + prominence);
    }
}

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
