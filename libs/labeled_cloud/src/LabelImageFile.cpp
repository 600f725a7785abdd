#include <labeled_cloud/LabelFolder.h>
#include <png.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <unordered_map>

namespace labeled_cloud {

using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::Color;
using semantic_types::kNoClass;

namespace {

/** Class of each pixel value, looked up once per value. */
template <typename LookUp>
class Cached {
 public:
  explicit Cached(LookUp lookUp) : m_lookUp(lookUp) {}
  ClassId operator()(std::uint32_t value) {
    if (m_last && m_last->first == value) return m_last->second;
    auto found = m_known.find(value);
    if (found == m_known.end()) found = m_known.emplace(value, m_lookUp(value)).first;
    m_last = &*found;
    return found->second;
  }

 private:
  LookUp m_lookUp;
  std::unordered_map<std::uint32_t, ClassId> m_known;
  const std::pair<const std::uint32_t, ClassId>* m_last = nullptr;
};

ClassId classOfColor(const ClassTable& table, std::uint32_t bgr) {
  const Color color{std::uint8_t(bgr >> 16), std::uint8_t(bgr >> 8), std::uint8_t(bgr)};
  if (const auto id = table.find(color)) return *id;
  if (bgr == 0) return table.fromRaw(0);
  if (table.unknownRawId() == ClassTable::UnknownRawId::NoClass) return kNoClass;
  throw std::invalid_argument("color (" + std::to_string(color.r) + ", " + std::to_string(color.g) +
                              ", " + std::to_string(color.b) + ") is not in the class table");
}

/** Classes of an image whose pixel (row, col) has the value VALUE_AT(row, col). */
template <typename ValueAt, typename LookUp>
LabelImage classify(int rows, int cols, ValueAt valueAt, LookUp lookUp) {
  LabelImage image;
  image.rows = rows, image.cols = cols;
  image.classes.reserve(std::size_t(rows) * cols);
  Cached<LookUp> classOf(lookUp);
  for (int row = 0; row < rows; ++row)
    for (int col = 0; col < cols; ++col) try {
        image.classes.push_back(classOf(valueAt(row, col)));
      } catch (const std::invalid_argument& e) {
        throw std::runtime_error(std::string(e.what()) + " (pixel in row " + std::to_string(row) +
                                 ", column " + std::to_string(col) + ")");
      }
  return image;
}

/** What a PNG file's header says, as far as OpenCV would lose it. */
struct PngHeader {
  bool palette = false;
  /** Gray with 1, 2 or 4 bits: OpenCV would stretch the values. */
  bool narrowGray = false;
};

PngHeader readPngHeader(const std::string& file) {
  unsigned char bytes[26] = {};
  std::ifstream stream(file, std::ios::binary);
  stream.read(reinterpret_cast<char*>(bytes), sizeof bytes);
  if (!stream || png_sig_cmp(bytes, 0, 8) != 0) return {};
  const int bitDepth = bytes[24], colorType = bytes[25];
  return {colorType == PNG_COLOR_TYPE_PALETTE, colorType == PNG_COLOR_TYPE_GRAY && bitDepth < 8};
}

/** The palette's indices: OpenCV gives its colors only. */
LabelImage readPaletteIndices(const std::string& file, const ClassTable& table) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  const auto check = [&png](int ok) {
    if (!ok) throw std::runtime_error(png.message);
  };
  check(png_image_begin_read_from_file(&png, file.c_str()));
  png.format = PNG_FORMAT_RGB_COLORMAP;
  std::vector<std::uint8_t> indices(PNG_IMAGE_SIZE(png)), palette(PNG_IMAGE_COLORMAP_SIZE(png));
  check(png_image_finish_read(&png, nullptr, indices.data(), 0, palette.data()));
  const int cols = static_cast<int>(png.width);
  return classify(
      static_cast<int>(png.height), cols,
      [&](int row, int col) { return indices[std::size_t(row) * cols + col]; },
      [&table](std::uint32_t id) { return table.fromRaw(id); });
}

LabelImage readPixels(const std::string& file, const ClassTable& table) {
  const cv::Mat pixels = cv::imread(file, cv::IMREAD_UNCHANGED);
  const auto raw = [&table](std::uint32_t id) { return table.fromRaw(id); };
  const auto colored = [&table](std::uint32_t bgr) { return classOfColor(table, bgr); };
  const auto bgrOf = [](const auto& p) { return std::uint32_t(p[2] << 16 | p[1] << 8 | p[0]); };
  const int rows = pixels.rows, cols = pixels.cols;
  if (pixels.empty()) throw std::runtime_error("cannot be read as an image");
  switch (pixels.type()) {
    case CV_8UC1:
      return classify(
          rows, cols, [&](int r, int c) { return pixels.at<std::uint8_t>(r, c); }, raw);
    case CV_16UC1:
      return classify(
          rows, cols, [&](int r, int c) { return pixels.at<std::uint16_t>(r, c); }, raw);
    case CV_8UC3:
      return classify(
          rows, cols, [&](int r, int c) { return bgrOf(pixels.at<cv::Vec3b>(r, c)); }, colored);
    case CV_8UC4:
      return classify(
          rows, cols, [&](int r, int c) { return bgrOf(pixels.at<cv::Vec4b>(r, c)); }, colored);
    default:
      throw std::runtime_error("expected ids of 8 or 16 bits, a palette, or 8-bit colors");
  }
}

}  // namespace

LabelImage readLabelImage(const std::filesystem::path& file, const ClassTable& table) {
  try {
    if (!std::filesystem::is_regular_file(file)) throw std::runtime_error("there is no such file");
    const PngHeader header = readPngHeader(file.string());
    if (header.narrowGray)
      throw std::runtime_error("gray with fewer than 8 bits: save it with 8 or with a palette");
    LabelImage image = header.palette ? readPaletteIndices(file.string(), table)
                                      : readPixels(file.string(), table);
    image.origin = file.string();
    return image;
  } catch (const std::exception& e) {
    throw std::runtime_error(file.string() + ": " + e.what());
  }
}

void readConfidences(const std::filesystem::path& file, LabelImage& image) {
  const cv::Mat pixels = std::filesystem::is_regular_file(file)
                             ? cv::imread(file.string(), cv::IMREAD_UNCHANGED)
                             : cv::Mat();
  if (pixels.type() != CV_8UC1 && pixels.type() != CV_16UC1)
    throw std::runtime_error(file.string() + ": expected confidences as gray of 8 or 16 bits");
  if (pixels.rows != image.rows || pixels.cols != image.cols)
    throw std::runtime_error(file.string() + ": " + std::to_string(pixels.cols) + " x " +
                             std::to_string(pixels.rows) + " confidences for " +
                             std::to_string(image.cols) + " x " + std::to_string(image.rows) +
                             " labels");
  cv::Mat1f shares;
  pixels.convertTo(shares, CV_32F, pixels.depth() == CV_8U ? 1 / 255.0 : 1 / 65535.0);
  image.confidences.assign(shares.begin(), shares.end());
}

}  // namespace labeled_cloud
