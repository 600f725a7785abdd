#include "ImageFields.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <stdexcept>

#include "PointFields.h"

namespace point_fields {

using labeled_cloud::LabelImage;
using mrpt::obs::CObservation3DRangeScan;
using semantic_types::ClassTable;

namespace {

/** Pixels of an image as they came; rows may have a rest. */
class Pixels {
 public:
  /** \throw std::runtime_error the data are too short */
  Pixels(const RawImage& image, std::size_t bytes) : m_image(image), m_bytes(bytes) {
    const std::uint64_t row = std::uint64_t(image.width) * bytes;
    constexpr std::uint64_t kMost = 40'000'000;
    const bool fits = image.height > 0 && image.width > 0 && image.step >= row &&
                      std::uint64_t(image.width) * image.height <= kMost &&
                      std::uint64_t(image.step) * (image.height - 1) + row <= image.size;
    if (!fits)
      throw std::runtime_error(std::to_string(image.size) + " bytes are no image of " +
                               std::to_string(image.width) + " x " + std::to_string(image.height) +
                               " pixels of " + std::to_string(bytes) + " bytes");
    const std::uint16_t one = 1;
    std::uint8_t first;
    std::memcpy(&first, &one, 1);
    m_swaps = image.isBigEndian == (first == 1);
  }
  template <class T>
  T at(std::uint32_t row, std::uint32_t column) const {
    std::uint8_t bytes[sizeof(T)];
    std::memcpy(bytes, begin(row, column), sizeof(T));
    if (m_swaps) std::reverse(bytes, bytes + sizeof(T));
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
  }
  const std::uint8_t* begin(std::uint32_t row, std::uint32_t column) const {
    return m_image.data + std::size_t(row) * m_image.step + column * m_bytes;
  }

 private:
  const RawImage& m_image;
  std::size_t m_bytes;
  bool m_swaps;
};

[[noreturn]] void refuseEncoding(const RawImage& image, const std::string& expected) {
  throw std::runtime_error("encoding '" + image.encoding + "', expected " + expected);
}

/** What a pixel is known by: a raw id, or a color 0xRRGGBB.
 * \throw std::runtime_error it is no label image */
std::function<double(std::uint32_t, std::uint32_t)> numberReader(const RawImage& image) {
  const std::string& encoding = image.encoding;
  if (encoding == "mono8" || encoding == "8UC1")
    return [p = Pixels(image, 1)](auto r, auto c) { return *p.begin(r, c); };
  if (encoding == "mono16" || encoding == "16UC1")
    return [p = Pixels(image, 2)](auto r, auto c) { return p.template at<std::uint16_t>(r, c); };
  if (encoding != "rgb8" && encoding != "bgr8")
    refuseEncoding(image, "mono8, mono16, 8UC1, 16UC1 (raw ids), rgb8 or bgr8 (colors)");
  const int red = encoding[0] == 'r' ? 0 : 2;
  return [red, p = Pixels(image, 3)](auto r, auto c) {
    const std::uint8_t* pixel = p.begin(r, c);
    return pixel[red] << 16 | pixel[1] << 8 | pixel[2 - red];
  };
}

/** Millimeters, as MRPT's range images have them; 0: no return. */
void setRanges(const RawImage& image, CObservation3DRangeScan& scan) {
  if (!mayBeDepth(image.encoding)) refuseEncoding(image, "16UC1 (mm) or 32FC1 (m)");
  const bool areMeters = image.encoding == "32FC1";
  const Pixels pixels(image, areMeters ? 4 : 2);
  const auto rows = static_cast<int>(image.height), cols = static_cast<int>(image.width);
  scan.hasRangeImage = true;
  scan.range_is_depth = true;
  scan.rangeUnits = 0.001f;
  scan.rangeImage_setSize(rows, cols);
  for (int row = 0; row < rows; ++row)
    for (int col = 0; col < cols; ++col) {
      const double mm = areMeters
                            ? std::round(1000.0 * static_cast<double>(pixels.at<float>(row, col)))
                            : pixels.at<std::uint16_t>(row, col);
      scan.rangeImage(row, col) = mm > 0 && mm <= 65535 ? static_cast<std::uint16_t>(mm) : 0;
    }
}

/** \throw std::runtime_error it is of another image, or has no calibration that is known here */
mrpt::img::TCamera cameraOf(const RawCamera& raw, const RawImage& image) {
  if (raw.width != image.width || raw.height != image.height)
    throw std::runtime_error("the camera's calibration is for " + std::to_string(raw.width) +
                             " x " + std::to_string(raw.height) + " pixels, the image has " +
                             std::to_string(image.width) + " x " + std::to_string(image.height));
  const auto& k = raw.matrix;
  if (!(k[0] > 0) || !(k[4] > 0)) throw std::runtime_error("the camera is not calibrated");
  mrpt::img::TCamera camera;
  camera.ncols = raw.width, camera.nrows = raw.height;
  camera.setIntrinsicParamsFromValues(k[0], k[4], k[2], k[5]);
  if (raw.distortion.empty()) return camera;
  if (raw.model != "plumb_bob" || raw.distortion.size() != 5)
    throw std::runtime_error("distortion model '" + raw.model +
                             "', expected plumb_bob of 5 numbers");
  camera.distortion = mrpt::img::DistortionModel::plumb_bob;
  std::copy(raw.distortion.begin(), raw.distortion.end(), camera.dist.begin());
  return camera;
}

}  // namespace

LabelImage labelsOf(const RawImage& image, const ClassTable& table, std::string& problem) {
  const auto numberAt = numberReader(image);
  NumberedClasses classes(table, image.encoding.find('g') != std::string::npos);
  LabelImage labels;
  labels.rows = static_cast<int>(image.height), labels.cols = static_cast<int>(image.width);
  labels.classes.reserve(std::size_t(image.width) * image.height);
  for (std::uint32_t row = 0; row < image.height; ++row)
    for (std::uint32_t column = 0; column < image.width; ++column)
      labels.classes.push_back(classes.at(numberAt(row, column)));
  labels.origin = "the label image";
  problem = classes.problem();
  return labels;
}

bool mayBeDepth(const std::string& encoding) {
  return encoding == "32FC1" || encoding == "16UC1" || encoding == "mono16";
}

CObservation3DRangeScan depthOf(const RawImage& image, const RawCamera& camera) {
  CObservation3DRangeScan scan;
  scan.cameraParams = cameraOf(camera, image);
  setRanges(image, scan);
  return scan;
}

Eigen::Isometry3d T_optical_camera() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return T;
}

}  // namespace point_fields
