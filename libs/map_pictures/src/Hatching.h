#pragma once
#include <map_pictures/MapCanvas.h>

#include <opencv2/core.hpp>

namespace map_pictures {

/** The color of a pixel in stripes along a diagonal: those of the color, and paler ones.
 * \param x, y of the pixel, not negative \param period from one stripe to the next, pixels */
inline cv::Vec3b hatched(const cv::Vec3b& color, int x, int y, int period) {
  constexpr double kColor = 0.35;
  if (2 * ((x + y) % period) < period) return color;
  const cv::Scalar paper = bgr(kPaper);
  cv::Vec3b pale;
  for (int i = 0; i < 3; ++i)
    pale[i] = cv::saturate_cast<std::uint8_t>(kColor * color[i] + (1 - kColor) * paper[i]);
  return pale;
}

}  // namespace map_pictures
