#include <mrpt_compat/Images.h>
#include <mrpt_compat/Release.h>

#include <opencv2/imgproc.hpp>

namespace mrpt_compat {

#if MSO_MRPT_AT_LEAST(3, 0, 0)

namespace {

/** The image's own memory: gray, RGB or RGBA. */
cv::Mat pixelsOf(const mrpt::img::CImage& image) {
  if (image.getPixelDepth() != mrpt::img::PixelDepth::D8U)
    throw std::runtime_error("expected an image with 8 bits a channel, not 16");
  const auto* first = image.ptrLine<std::uint8_t>(0);
  return {static_cast<int>(image.getHeight()), static_cast<int>(image.getWidth()),
          CV_8UC(static_cast<int>(image.channels())), const_cast<std::uint8_t*>(first),
          image.getRowStride()};
}

}  // namespace

cv::Mat toOpenCv(const mrpt::img::CImage& image) {
  const cv::Mat pixels = pixelsOf(image);
  if (pixels.channels() == 1) return pixels.clone();
  cv::Mat result;
  cv::cvtColor(pixels, result, pixels.channels() == 3 ? cv::COLOR_RGB2BGR : cv::COLOR_RGBA2BGR);
  return result;
}

mrpt::img::CImage toMrpt(const cv::Mat& image) {
  mrpt::img::CImage result(image.cols, image.rows,
                           image.channels() == 1 ? mrpt::img::CH_GRAY : mrpt::img::CH_RGB);
  cv::Mat pixels = pixelsOf(result);
  if (image.channels() == 1)
    image.copyTo(pixels);
  else
    cv::cvtColor(image, pixels, cv::COLOR_BGR2RGB);
  return result;
}

void writeImagesWithoutLoss() {}

#else

cv::Mat toOpenCv(const mrpt::img::CImage& image) {
  return image.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY);
}

mrpt::img::CImage toMrpt(const cv::Mat& image) { return {image, mrpt::img::DEEP_COPY}; }

void writeImagesWithoutLoss() { mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(true); }

#endif

}  // namespace mrpt_compat
