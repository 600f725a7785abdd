#pragma once
#include <strict_files/OutputFiles.h>
#include <opencv2/core.hpp>

#include <filesystem>
#include <memory>

struct GifFileType;

namespace map_pictures {

/** An animation that plays again and again, written frame by frame: of each only what changed
 * visibly, in at most 63 colors. The file is complete or untouched. */
class GifFile {
 public:
  /** \param secondsPerFrame a multiple of 0.01 s
   * \throw std::runtime_error naming the file: it cannot be written
   * \throw std::invalid_argument secondsPerFrame is not between 0.01 and 655 s */
  GifFile(const std::filesystem::path& file, double secondsPerFrame);
  /** Without close(), there is no file. */
  ~GifFile();

  /** \param frame BGR, 8 bits, of the first one's size
   * \throw std::invalid_argument another type or size
   * \throw std::runtime_error naming the file: it cannot be written */
  void add(const cv::Mat& frame);
  /** \throw std::runtime_error naming the file: it cannot be written, or has no frame */
  void close();

 private:
  void begin(const cv::Size& size);
  void writeFrame(const cv::Mat& part, const cv::Mat& changed, const cv::Point& corner);
  void check(int gifResult) const;
  [[noreturn]] void fail(int gifError) const;

  std::filesystem::path m_file;
  strict_files::StagedFile m_staged;
  int m_delay;  ///< 0.01 s
  int m_openError = 0;
  std::unique_ptr<GifFileType, void (*)(GifFileType*)> m_gif;
  cv::Mat m_shown;  ///< by a viewer
};

}  // namespace map_pictures
