#include "Relief.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

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

}  // namespace

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

}  // namespace map_pictures
