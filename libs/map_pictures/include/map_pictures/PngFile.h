#pragma once
#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>

namespace map_pictures {

/** A picture that is written from top to bottom, without being in memory as a whole; as
 * savePicture() writes those that are. */
class PngFile {
 public:
  /** \param size pixels \throw std::runtime_error naming the file: it cannot be written */
  PngFile(const std::filesystem::path& file, const cv::Size& size);
  /** Without close(), there is no file. */
  ~PngFile();

  /** \param rows BGR, 8 bits, as wide as the picture
   * \throw std::invalid_argument another type or width, or more rows than the picture has
   * \throw std::runtime_error naming the file: it cannot be written */
  void add(const cv::Mat& rows);
  /** \throw std::runtime_error naming the file: it cannot be written
   * \throw std::invalid_argument rows are missing */
  void close();

 private:
  struct Writing;
  std::unique_ptr<Writing> m;
};

}  // namespace map_pictures
