#include <gif_lib.h>
#include <map_pictures/PictureFiles.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace map_pictures {
namespace {

constexpr std::size_t kMostColors = 63;

/** At most 63 colors that stand for all of a picture. */
class GifPalette {
 public:
  /** \param picture BGR \param mask 8 bit, of its size: pixels that count */
  GifPalette(const cv::Mat& picture, const cv::Mat& mask) : m_index(1 << 15, 0) {
    std::vector<cv::Vec4d> cells(1 << 15);  // sum of colors, and their number
    for (int row = 0; row < picture.rows; ++row)
      for (int col = 0; col < picture.cols; ++col) {
        const auto& c = picture.at<cv::Vec3b>(row, col);
        if (mask.at<std::uint8_t>(row, col)) cells[cellOf(c)] += cv::Vec4d(c[0], c[1], c[2], 1);
      }
    const double weight = 2000.0 / cv::countNonZero(mask);
    cv::Mat samples, labels, centers;
    std::vector<std::pair<std::size_t, int>>
        places;  // cells that are there: the first sample of each
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const cv::Vec4d& cell = cells[i];
      if (cell[3] == 0) continue;
      places.emplace_back(i, samples.rows);
      const cv::Vec3d mean = cv::Vec3d(cell.val) / cell[3];
      for (int n = 0; n <= int(weight * cell[3]); ++n) samples.push_back(cv::Vec3f(mean));
    }
    const int colors = int(std::min(kMostColors, places.size()));
    if (colors == 0) return;
    cv::setRNGSeed(0);
    cv::kmeans(samples, colors, labels, {cv::TermCriteria::COUNT, 10, 0}, 1, cv::KMEANS_PP_CENTERS,
               centers);
    centers.convertTo(centers, CV_8U);
    for (int i = 0; i < colors; ++i) m_colors.push_back(cv::Vec3b(centers.ptr(i)));
    for (const auto& [cell, sample] : places) m_index[cell] = std::uint8_t(labels.at<int>(sample));
  }

  /** BGR. */
  const std::vector<cv::Vec3b>& colors() const { return m_colors; }
  /** Which of the colors stands for one that was in the picture. */
  std::uint8_t indexOf(const cv::Vec3b& color) const { return m_index[cellOf(color)]; }

 private:
  /** Colors that differ in the last 3 bits of a channel only are one. */
  static std::size_t cellOf(const cv::Vec3b& c) {
    return std::size_t(c[0] >> 3 << 10 | c[1] >> 3 << 5 | c[2] >> 3);
  }

  std::vector<cv::Vec3b> m_colors;
  std::vector<std::uint8_t> m_index;
};

constexpr int kUnchanged = 0;  ///< index of the transparent color; those of the palette follow

void closeQuietly(GifFileType* gif) {
  int error = 0;
  EGifCloseFile(gif, &error);
}

int hundredths(double seconds) {
  const double delay = std::round(seconds * 100);
  if (!(delay >= 1 && delay <= 65535))
    throw std::invalid_argument("GIF: secondsPerFrame is " + std::to_string(seconds) +
                                ", expected 0.01 to 655 s");
  return int(delay);
}

std::unique_ptr<ColorMapObject, decltype(&GifFreeMapObject)> colorMapOf(const GifPalette& palette) {
  const int used = int(palette.colors().size()) + 1;
  ColorMapObject* map = GifMakeMapObject(1 << std::max(1, GifBitSize(used)), nullptr);
  if (!map) throw std::bad_alloc();
  for (int i = 1; i < used; ++i) {
    const cv::Vec3b& color = palette.colors()[i - 1];
    map->Colors[i] = {color[2], color[1], color[0]};
  }
  return {map, GifFreeMapObject};
}

/** Where a picture differs visibly from what is shown, 8 bit. */
cv::Mat changes(const cv::Mat& picture, const cv::Mat& shown) {
  constexpr int kInvisible = 12;  // of 255
  cv::Mat difference, same;
  cv::absdiff(picture, shown, difference);
  cv::inRange(difference, cv::Scalar::all(0), cv::Scalar::all(kInvisible), same);
  return ~same;
}

}  // namespace

GifFile::GifFile(const std::filesystem::path& file, double secondsPerFrame)
    : m_file(file),
      m_staged(file),
      m_delay(hundredths(secondsPerFrame)),
      m_gif(EGifOpenFileName(m_staged.path().c_str(), false, &m_openError), closeQuietly) {
  if (!m_gif) fail(m_openError);
}

GifFile::~GifFile() = default;

void GifFile::fail(int gifError) const {
  const char* why = GifErrorString(gifError);
  throw std::runtime_error("cannot write '" + m_file.string() +
                           "': " + (why ? why : "unknown error"));
}

void GifFile::check(int gifResult) const {
  if (gifResult == GIF_ERROR) fail(m_gif->Error);
}

void GifFile::begin(const cv::Size& size) {
  EGifSetGifVersion(m_gif.get(), true);
  check(EGifPutScreenDesc(m_gif.get(), size.width, size.height, 8, 0, nullptr));
  const unsigned char forever[] = {1, 0, 0};
  check(EGifPutExtensionLeader(m_gif.get(), APPLICATION_EXT_FUNC_CODE));
  check(EGifPutExtensionBlock(m_gif.get(), 11, "NETSCAPE2.0"));
  check(EGifPutExtensionBlock(m_gif.get(), sizeof forever, forever));
  check(EGifPutExtensionTrailer(m_gif.get()));
}

void GifFile::add(const cv::Mat& frame) {
  if (frame.type() != CV_8UC3 || frame.empty() || frame.cols > 65535 || frame.rows > 65535)
    throw std::invalid_argument("GIF: a frame is no picture of 3 channels of 8 bits");
  const bool first = m_shown.empty();
  if (!first && frame.size() != m_shown.size())
    throw std::invalid_argument("GIF: frames differ in size");
  if (first) begin(frame.size());
  const cv::Mat changed =
      first ? cv::Mat(frame.size(), CV_8U, cv::Scalar(255)) : changes(frame, m_shown);
  if (first) m_shown = frame.clone();
  cv::Rect part = cv::boundingRect(changed);
  if (part.empty()) part = {0, 0, 1, 1};  // no frame is without a pixel
  writeFrame(frame(part), changed(part), part.tl());
}

void GifFile::writeFrame(const cv::Mat& part, const cv::Mat& changed, const cv::Point& corner) {
  const GraphicsControlBlock control{DISPOSE_DO_NOT, false, m_delay, kUnchanged};
  GifByteType bytes[4];
  const std::size_t numBytes = EGifGCBToExtension(&control, bytes);
  check(EGifPutExtension(m_gif.get(), GRAPHICS_EXT_FUNC_CODE, int(numBytes), bytes));
  const GifPalette palette(part, changed);
  check(EGifPutImageDesc(m_gif.get(), corner.x, corner.y, part.cols, part.rows, false,
                         colorMapOf(palette).get()));
  std::vector<GifPixelType> line(part.cols);
  for (int row = 0; row < part.rows; ++row) {
    for (int col = 0; col < part.cols; ++col) {
      line[col] = kUnchanged;
      if (!changed.at<std::uint8_t>(row, col)) continue;
      const int index = palette.indexOf(part.at<cv::Vec3b>(row, col));
      line[col] = GifPixelType(1 + index);
      m_shown.at<cv::Vec3b>(corner.y + row, corner.x + col) = palette.colors()[index];
    }
    check(EGifPutLine(m_gif.get(), line.data(), part.cols));
  }
}

void GifFile::close() {
  if (m_shown.empty())
    throw std::runtime_error("cannot write '" + m_file.string() + "': no frames");
  int error = 0;
  if (EGifCloseFile(m_gif.release(), &error) == GIF_ERROR) fail(error);
  m_staged.commit();
}

}  // namespace map_pictures
