#pragma once
#include <mrpt/img/CImage.h>
#include <mrpt/img/color_maps.h>
#include <mrpt_compat/Release.h>

#include <opencv2/core/mat.hpp>

namespace mrpt_compat {

/** A copy of the pixels, 8 bits in one or three channels (BGR), rows x columns. Until MRPT 3 an
 * image holds an OpenCV one. \throw std::exception if it is empty, or has other pixels. */
cv::Mat toOpenCv(const mrpt::img::CImage& image);

/** A copy of an OpenCV image as one of MRPT. */
mrpt::img::CImage toMrpt(const cv::Mat& image);

/** From now on this process writes images into rawlogs as they are, not as JPEG. Since MRPT 3 they
 * always are. */
void writeImagesWithoutLoss();

/** \param hue, saturation, value 0 to 1 */
inline mrpt::img::TColorf colorOfHue(float hue, float saturation, float value) {
#if MSO_MRPT_AT_LEAST(3, 0, 0)
  return mrpt::img::hsv2rgb(hue, saturation, value);
#else
  mrpt::img::TColorf color;
  mrpt::img::hsv2rgb(hue, saturation, value, color.R, color.G, color.B);
  return color;
#endif
}

}  // namespace mrpt_compat
