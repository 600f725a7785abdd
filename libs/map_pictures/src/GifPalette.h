#pragma once
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace map_pictures {

/** At most 63 colors that stand for all of a picture, found by median cut. */
class GifPalette {
 public:
  /** \param picture BGR \param mask 8 bit, of its size: pixels that count */
  GifPalette(const cv::Mat& picture, const cv::Mat& mask);

  /** BGR. */
  const std::vector<cv::Vec3b>& colors() const { return m_colors; }
  /** Which of the colors stands for one that was in the picture. */
  std::uint8_t indexOf(const cv::Vec3b& color) const { return m_index[cellOf(color)]; }

 private:
  /** Colors that differ in the last 3 bits of a channel only are one. */
  static int cellOf(const cv::Vec3b& c) { return c[0] >> 3 << 10 | c[1] >> 3 << 5 | c[2] >> 3; }

  std::vector<cv::Vec3b> m_colors;
  std::vector<std::uint8_t> m_index;
};

}  // namespace map_pictures
