#pragma once
#include <opencv2/core.hpp>

namespace map_pictures {

/** Shades an image of columns by their heights, as maps do: lit from the upper left, and what
 * stands out of its surroundings brighter than what lies low. \param color BGR \param height 32 bit
 * float, m, NaN where there is nothing \param cell m */
void shadeByRelief(cv::Mat& color, const cv::Mat& height, double cell);

}  // namespace map_pictures
