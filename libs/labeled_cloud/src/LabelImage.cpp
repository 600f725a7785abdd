#include <labeled_cloud/LabelImage.h>

#include <labeled_cloud/Pictures.h>
#include <labeled_cloud/Trajectory.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>
#include <opencv2/core.hpp>

#include <cmath>
#include <stdexcept>
#include <unordered_map>

#include "PointLabels.h"

namespace labeled_cloud {

using mrpt::Clock;
using mrpt::obs::CObservation;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationImage;
using mrpt::obs::TPixelLabelInfo;
using mrpt::obs::TPixelLabelInfoBase;
using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::Color;
using semantic_types::kNoClass;

std::optional<std::size_t> LabelImage::cellAt(double u, double v) const {
  const double col = std::floor((u + 0.5) * cells.scaleX);
  const double row = std::floor((v + 0.5) * cells.scaleY - cells.shiftY);
  if (!(col >= 0 && col < cols && row >= 0 && row < rows)) return std::nullopt;
  return static_cast<std::size_t>(row) * cols + static_cast<std::size_t>(col);
}

ClassId LabelImage::classOf(std::size_t cell) const {
  if (probabilities.empty()) return classes[cell];
  const std::size_t plane = std::size_t(rows) * cols, planes = probabilities.size() / plane;
  ClassId best = kNoClass;
  float most = 0;
  for (std::size_t k = 0; k < planes; ++k) {
    const float p = probabilities[k * plane + cell];
    if (p > most) most = p, best = static_cast<ClassId>(k + 1);
  }
  return best;
}

namespace {

/** Class of each pixel value or label, looked up when it is met first: labels that no pixel has
 * need no class. */
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

ClassId classOfLabel(std::uint32_t label, const TPixelLabelInfoBase& labels,
                     const ClassTable& table) {
  const auto name = labels.pixelLabelNames.find(static_cast<int>(label));
  if (name == labels.pixelLabelNames.end()) return table.fromRaw(label);
  if (const auto id = table.find(name->second)) return *id;
  if (table.unknownRawId() == ClassTable::UnknownRawId::NoClass) return kNoClass;
  throw std::invalid_argument("label " + std::to_string(label) + " is named '" + name->second +
                              "', which is no class of the table");
}

/** Fills IMAGE if the bit fields are BYTES wide. */
template <unsigned BYTES>
bool convert(const TPixelLabelInfoBase& labels, const ClassTable& table, LabelImage& image) {
  const auto* fields = dynamic_cast<const TPixelLabelInfo<BYTES>*>(&labels);
  if (!fields) return false;
  const auto& bits = fields->pixelLabels;
  image.rows = static_cast<int>(bits.rows());
  image.cols = static_cast<int>(bits.cols());
  image.classes.reserve(bits.size());
  Cached classOf([&](std::uint32_t label) { return classOfLabel(label, labels, table); });
  for (int row = 0; row < image.rows; ++row)
    for (int col = 0; col < image.cols; ++col) {
      const std::uint64_t set = bits(row, col);
      image.classes.push_back(set ? classOf(std::uint32_t(__builtin_ctzll(set))) : kNoClass);
    }
  return true;
}

}  // namespace

std::optional<LabelImage> EmbeddedLabels::label(const mrpt::obs::CObservation& observation) {
  const auto* scan = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation);
  if (!scan || !scan->pixelLabels) return std::nullopt;
  const TPixelLabelInfoBase& labels = *scan->pixelLabels;
  LabelImage image;
  image.view = m_view;
  image.origin = "pixelLabels of '" + scan->sensorLabel + "'";
  try {
    if (!convert<1>(labels, m_table, image) && !convert<2>(labels, m_table, image) &&
        !convert<3>(labels, m_table, image) && !convert<4>(labels, m_table, image) &&
        !convert<8>(labels, m_table, image))
      throw std::invalid_argument(std::to_string(8 * labels.BITFIELD_BYTES) + " labels a pixel");
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(image.origin + ": " + e.what());
  }
  return image;
}

namespace fs = std::filesystem;

namespace {

constexpr const char* kConfidence = ".confidence";

bool isLabelImage(const fs::path& file) {
  return fs::is_regular_file(file) && file.extension() == ".png" &&
         file.stem().extension() != kConfidence;
}

/** Where the confidences of a label image are. */
fs::path confidencesOf(const fs::path& labels) {
  return labels.parent_path() /
         (labels.stem().string() + kConfidence + labels.extension().string());
}

Clock::time_point timeInName(const fs::path& file) {
  const std::string stem = file.stem().string();
  try {
    return timeOfSeconds(strict_files::numberOf(stem));
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(file.string() +
                             ": the label image's name is not a time in seconds: " + e.what());
  }
}

/** Name of the first image of the observation that is stored in a file of its own. */
std::string externalName(const CObservation& observation) {
  if (const auto* picture = dynamic_cast<const CObservationImage*>(&observation))
    if (picture->image.isExternallyStored()) return picture->image.getExternalStorageFile();
  if (const auto* scan = dynamic_cast<const CObservation3DRangeScan*>(&observation)) {
    if (scan->hasIntensityImage && scan->intensityImage.isExternallyStored())
      return scan->intensityImage.getExternalStorageFile();
    if (scan->rangeImage_isExternallyStored()) return scan->rangeImage_getExternalStorageFile("");
  }
  throw std::runtime_error("the observation '" + observation.sensorLabel +
                           "' has no external image after which a label image could be named; "
                           "match = time needs none");
}

}  // namespace

void LabelFolderOptions::describe(strict_files::OptionList& list) {
  list.add("match", match, "",
           "how label images are found: their names are times, or those of the observations' own "
           "images");
  list.add("tolerance", tolerance, "s", strict_files::atLeast(0).orInfinite(),
           "largest difference to the observation's time");
  list.add("image", view, "", "which image of a depth and color camera the labels belong to");
}

void LabelFolderOptions::validate() const {
  strict_files::checkOptions(*this, "LabelFolderOptions");
}

LabelFolder::LabelFolder(const fs::path& folder, const semantic_types::ClassTable& table,
                         const LabelFolderOptions& options)
    : m_folder(folder), m_table(table), m_options(options) {
  m_options.validate();
  if (!fs::is_directory(folder))
    throw std::runtime_error(folder.string() + ": there is no such folder of label images");
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (!isLabelImage(entry.path())) continue;
    const bool added = m_options.match == LabelFolderOptions::Match::Time
                           ? m_byTime.emplace(timeInName(entry.path()), entry.path()).second
                           : m_byName.emplace(entry.path().stem().string(), entry.path()).second;
    if (!added)
      throw std::runtime_error(entry.path().string() + ": a second label image of this " +
                               (m_byName.empty() ? "time" : "name"));
  }
  if (m_byTime.empty() && m_byName.empty())
    throw std::runtime_error(folder.string() + ": no label image in this folder");
  const fs::path& first = m_byTime.empty() ? m_byName.begin()->second : m_byTime.begin()->second;
  m_withConfidences = fs::exists(confidencesOf(first));
}

std::optional<fs::path> LabelFolder::nearest(Clock::time_point time) const {
  const std::chrono::duration<double> tolerance(m_options.tolerance);
  return nearestIn(m_byTime, time, std::chrono::duration_cast<Clock::duration>(tolerance));
}

std::optional<fs::path> LabelFolder::named(const CObservation& observation) const {
  const auto found = m_byName.find(fs::path(externalName(observation)).stem().string());
  if (found == m_byName.end()) return std::nullopt;
  return found->second;
}

std::optional<fs::path> LabelFolder::fileOf(const CObservation& observation) const {
  const bool byTime = m_options.match == LabelFolderOptions::Match::Time;
  return byTime ? nearest(observation.timestamp) : named(observation);
}

std::optional<LabelImage> LabelFolder::label(const CObservation& observation) {
  const auto file = fileOf(observation);
  if (!file) return std::nullopt;
  LabelImage image = readLabelImage(*file, m_table);
  image.view = m_options.view;
  if (m_withConfidences) readConfidences(confidencesOf(*file), image);
  return image;
}

namespace {

ClassId classOfColor(const ClassTable& table, std::uint32_t bgr) {
  const Color color{std::uint8_t(bgr >> 16), std::uint8_t(bgr >> 8), std::uint8_t(bgr)};
  if (const auto id = table.find(color)) return *id;
  if (bgr == 0) return table.fromRaw(0);
  if (table.unknownRawId() == ClassTable::UnknownRawId::NoClass) return kNoClass;
  throw std::invalid_argument("color (" + std::to_string(color.r) + ", " + std::to_string(color.g) +
                              ", " + std::to_string(color.b) + ") is not in the class table");
}

template <typename Pixel, typename ValueOf, typename LookUp>
LabelImage classify(const cv::Mat& pixels, ValueOf valueOf, LookUp lookUp) {
  LabelImage image;
  image.rows = pixels.rows, image.cols = pixels.cols;
  image.classes.reserve(pixels.total());
  Cached classOf(lookUp);
  for (int row = 0; row < image.rows; ++row)
    for (int col = 0; col < image.cols; ++col) try {
        image.classes.push_back(classOf(valueOf(pixels.at<Pixel>(row, col))));
      } catch (const std::invalid_argument& e) {
        throw std::runtime_error(std::string(e.what()) + " (pixel in row " + std::to_string(row) +
                                 ", column " + std::to_string(col) + ")");
      }
  return image;
}

LabelImage classesOf(const cv::Mat& pixels, const ClassTable& table) {
  const auto raw = [&table](std::uint32_t id) { return table.fromRaw(id); };
  const auto colored = [&table](std::uint32_t bgr) { return classOfColor(table, bgr); };
  const auto same = [](std::uint32_t id) { return id; };
  const auto bgrOf = [](const auto& p) { return std::uint32_t(p[2] << 16 | p[1] << 8 | p[0]); };
  switch (pixels.type()) {
    case CV_8UC1:
      return classify<std::uint8_t>(pixels, same, raw);
    case CV_16UC1:
      return classify<std::uint16_t>(pixels, same, raw);
    case CV_8UC3:
      return classify<cv::Vec3b>(pixels, bgrOf, colored);
    case CV_8UC4:
      return classify<cv::Vec4b>(pixels, bgrOf, colored);
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

void PointLabels::take(std::size_t point, const LabelImage& image, std::size_t cell) {
  if (!image.probabilities.empty()) {
    const std::size_t plane = std::size_t(image.rows) * image.cols;
    const std::size_t classes = image.probabilities.size() / plane;
    m_probabilities.resize(m_points * classes);
    for (std::size_t k = 0; k < classes; ++k)
      m_probabilities[point * classes + k] = image.probabilities[k * plane + cell];
    return;
  }
  m_classes.resize(m_points);
  m_classes[point] = image.classes[cell];
  if (image.confidences.empty()) return;
  m_confidences.resize(m_points);
  m_confidences[point] = image.confidences[cell];
}

std::vector<float> PointLabels::moveTo(semantic_types::LabeledCloud& cloud) {
  cloud.classes = std::move(m_classes);
  cloud.probabilities = std::move(m_probabilities);
  return std::move(m_confidences);
}

}  // namespace labeled_cloud
