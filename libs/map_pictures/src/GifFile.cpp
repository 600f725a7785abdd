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

/** Pixels of nearly one color. */
struct Cell {
  int index = 0, count = 0;
  cv::Vec3d sum;

  double mean(int channel) const { return sum[channel] / count; }
};

using Cells = std::vector<Cell>;

/** Some of the cells, for which one color will stand. */
struct Box {
  Cells::iterator begin, end;
  int channel = 0;    ///< in which they differ most
  double spread = 0;  ///< how much, times the root of the number of pixels

  Box(Cells::iterator first, Cells::iterator last) : begin(first), end(last) {
    double count = 0;
    for (auto cell = begin; cell != end; ++cell) count += cell->count;
    for (int c = 0; c < 3; ++c) {
      const auto [low, high] = std::minmax_element(
          begin, end, [c](const Cell& a, const Cell& b) { return a.mean(c) < b.mean(c); });
      const double range = (high->mean(c) - low->mean(c)) * std::sqrt(count);
      if (range > spread) spread = range, channel = c;
    }
  }

  /** Where half of the pixels are on each side; both sides have cells. */
  Cells::iterator median() const {
    const int c = channel;
    std::sort(begin, end, [c](const Cell& a, const Cell& b) { return a.mean(c) < b.mean(c); });
    double count = 0, before = 0;
    for (auto cell = begin; cell != end; ++cell) count += cell->count;
    auto middle = begin;
    while (middle != end - 1 && before + middle->count <= count / 2) before += (middle++)->count;
    return std::max(middle, begin + 1);
  }
};

std::vector<Box> boxesOf(Cells& cells) {
  if (cells.empty()) return {};
  std::vector<Box> boxes = {Box(cells.begin(), cells.end())};
  while (boxes.size() < kMostColors) {
    const auto widest = std::max_element(
        boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a.spread < b.spread; });
    if (widest->spread <= 0) break;
    const auto middle = widest->median();
    const Box upper(middle, widest->end);
    *widest = Box(widest->begin, middle);
    boxes.push_back(upper);
  }
  return boxes;
}

cv::Vec3b meanOf(const Box& box) {
  cv::Vec3d sum;
  double count = 0;
  for (auto cell = box.begin; cell != box.end; ++cell) sum += cell->sum, count += cell->count;
  return sum / count;
}

/** At most 63 colors that stand for all of a picture, found by median cut. */
class GifPalette {
 public:
  /** \param picture BGR \param mask 8 bit, of its size: pixels that count */
  GifPalette(const cv::Mat& picture, const cv::Mat& mask) : m_index(1 << 15, 0) {
    std::vector<Cell> all(1 << 15);
    for (int row = 0; row < picture.rows; ++row)
      for (int col = 0; col < picture.cols; ++col) {
        if (!mask.at<std::uint8_t>(row, col)) continue;
        const auto& color = picture.at<cv::Vec3b>(row, col);
        Cell& cell = all[cellOf(color)];
        cell.index = cellOf(color);
        cell.sum += cv::Vec3d(color), ++cell.count;
      }
    all.erase(std::remove_if(all.begin(), all.end(), [](const Cell& cell) { return !cell.count; }),
              all.end());
    for (const Box& box : boxesOf(all)) {
      for (auto cell = box.begin; cell != box.end; ++cell)
        m_index[cell->index] = std::uint8_t(m_colors.size());
      m_colors.push_back(meanOf(box));
    }
  }

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
