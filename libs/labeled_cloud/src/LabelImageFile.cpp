#include <labeled_cloud/LabelImage.h>
#include <labeled_cloud/Pictures.h>

#include <opencv2/core.hpp>
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

LabelImage classesOf(const cv::Mat& pixels, const ClassTable& table) {
  const auto raw = [&table](std::uint32_t id) { return table.fromRaw(id); };
  const auto colored = [&table](std::uint32_t bgr) { return classOfColor(table, bgr); };
  const auto bgrOf = [](const auto& p) { return std::uint32_t(p[2] << 16 | p[1] << 8 | p[0]); };
  const int rows = pixels.rows, cols = pixels.cols;
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
  const cv::Mat pixels = readImageFile(file, ImageKinds::Lossless);
  try {
    LabelImage image = classesOf(pixels, table);
    image.origin = file.string();
    return image;
  } catch (const std::exception& e) {
    throw std::runtime_error(file.string() + ": " + e.what());
  }
}

void readConfidences(const std::filesystem::path& file, LabelImage& image) {
  const cv::Mat pixels = readImageFile(file, ImageKinds::Lossless);
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
