#include <labeled_cloud/ScanConverter.h>

#include <labeled_cloud/Trajectory.h>
#include <mrpt/core/bits_math.h>
#include <strict_files/OptionList.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "PointGrid.h"
#include "PointLabels.h"

namespace labeled_cloud {

using mrpt::img::TCamera;
using mrpt::obs::CObservation;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::poses::CPose3D;
using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::kNoClass;

namespace {

/** What a damaged file says of a camera could take all memory. */
constexpr double kMostPixels = 40e6;

/** MRPT 3's own error does not name the file. */
void checkDepthFile(const CObservation& observation) {
  const auto* scan = dynamic_cast<const CObservation3DRangeScan*>(&observation);
  if (!scan || !scan->hasRangeImage || !scan->rangeImage_isExternallyStored()) return;
  const std::string file = scan->rangeImage_getExternalStorageFileAbsolutePath("");
  if (!std::filesystem::exists(file)) throw std::runtime_error(file + ": no such file");
}

/** Holds what an observation stores in files of its own in memory for a while. */
class LoadedObservation {
 public:
  explicit LoadedObservation(const CObservation& observation) : m_observation(observation) {
    checkDepthFile(observation);
    m_observation.load();
  }
  ~LoadedObservation() { m_observation.unload(); }
  LoadedObservation(const LoadedObservation&) = delete;
  LoadedObservation& operator=(const LoadedObservation&) = delete;

 private:
  const CObservation& m_observation;
};

const CObservation3DRangeScan* asRangeScan(const CObservation& observation) {
  return dynamic_cast<const CObservation3DRangeScan*>(&observation);
}

/** Pixel of the nearest point of a block of the grid, if it has any. */
std::optional<std::size_t> nearestOfBlock(const PointGrid& grid, int top, int left, int size) {
  std::optional<std::size_t> best;
  for (int row = top; row < std::min(top + size, grid.rows); ++row)
    for (int col = left; col < std::min(left + size, grid.cols); ++col) {
      const std::size_t pixel = std::size_t(row) * grid.cols + col;
      if (!PointGrid::isReturn(grid.points[pixel])) continue;
      if (!best || grid.points[pixel].x() < grid.points[*best].x()) best = pixel;
    }
  return best;
}

/** The pixels that become points. */
std::vector<std::size_t> choosePixels(const PointGrid& grid, int decimation) {
  const auto blocks = [decimation](int n) {
    return std::size_t((n + decimation - 1) / decimation);
  };
  std::vector<std::size_t> pixels;
  pixels.reserve(blocks(grid.rows) * blocks(grid.cols));
  for (int row = 0; row < grid.rows; row += decimation)
    for (int col = 0; col < grid.cols; col += decimation)
      if (const auto pixel = nearestOfBlock(grid, row, col, decimation)) pixels.push_back(*pixel);
  return pixels;
}

/** Beyond the range that an observation states; how far does not matter. */
constexpr float kBeyond = 2;

/** The first pixel of each block, if it has no return. */
std::vector<Eigen::Vector3f> emptyPixels(const CObservation3DRangeScan& observation,
                                         const PixelRays& rays, int decimation) {
  std::vector<Eigen::Vector3f> empty;
  for (int row = 0; row < rays.rows(); row += decimation)
    for (int col = 0; col < rays.cols(); col += decimation) {
      if (observation.rangeImage(row, col) > 0) continue;
      const Eigen::Vector2f& ray = rays[std::size_t(row) * rays.cols() + col];
      empty.push_back(kBeyond * observation.maxRange * Eigen::Vector3f(1, ray.x(), ray.y()));
    }
  return empty;
}

}  // namespace

void ScanConverterOptions::describe(strict_files::OptionList& list) {
  using strict_files::atLeast;
  list.add("decimation", decimation, "pixels", atLeast(1),
           "depth images: one point, the nearest, for a square of so many; 2 to 4 for VGA and "
           "more");
  list.add("flying_pixel_threshold", flyingPixelThreshold, "", atLeast(0).below(1),
           "depth images: leaves out pixels that hang in the air at depth edges, farther from both "
           "sides than this share of their depth (0.02); 0: keeps all");
  list.add(
      "empty_carves", emptyCarves, "",
      "pixels and beams without a return carve up to the range that the observation states, and "
      "returns beyond it carve alone. Depth images of ROS state 65 m: set max_range. Not for "
      "sensors that lose returns");
  labels.describe(list);
}

void ScanConverterOptions::validate() const {
  strict_files::checkOptions(*this, "ScanConverterOptions");
}

ScanConverter::ScanConverter(const ClassTable& table, const ScanConverterOptions& options,
                             std::shared_ptr<ImageLabeler> labeler)
    : m_table(table), m_options(options), m_labeler(std::move(labeler)) {
  m_options.validate();
  if (!m_labeler) m_labeler = std::make_shared<EmbeddedLabels>(table);
}

ScanConverter::~ScanConverter() = default;

bool ScanConverter::accepts(const CObservation& observation) {
  return pointSourceOf(observation) || asRangeScan(observation);
}

std::optional<LabeledScan> ScanConverter::convert(const CObservation& observation) try {
  const auto source = pointSourceOf(observation);
  const auto* range = asRangeScan(observation);
  if (!source && !range) return std::nullopt;
  const LoadedObservation loaded(observation);
  LabeledScan scan;
  observation.getSensorPose(scan.T_robot_sensor);
  if (!toEigen(scan.T_robot_sensor).matrix().allFinite())
    throw std::invalid_argument("the sensor's pose is not finite");
  scan.timestamp = observation.timestamp;
  scan.sensorLabel = observation.sensorLabel;
  if (source) {
    addNamedCloud(source->read(observation), scan);
  } else {
    addRangeScan(*range, scan);
  }
  scan.counts.points = scan.cloud.size();
  scan.countLabels();
  return scan;
} catch (const std::exception& e) {
  throw std::runtime_error(nameOf(observation) + ": " + strict_files::messageOf(e));
}

void ScanConverter::addRangeScan(const CObservation3DRangeScan& observation, LabeledScan& scan) {
  if (!observation.hasRangeImage) throw std::invalid_argument("it has no range image");
  const mrpt::img::TCamera& camera = observation.cameraParams;
  if (double(camera.nrows) * camera.ncols > kMostPixels)
    throw std::invalid_argument("a camera of " + std::to_string(camera.ncols) + " x " +
                                std::to_string(camera.nrows) + " pixels; 40 million are allowed");
  checkSize(observation);
  if (!(m_rays && m_rays->isFor(camera))) m_rays = std::make_unique<PixelRays>(camera);
  PointGrid grid = unproject(observation, *m_rays);

  auto labels = m_labeler->label(observation);
  scan.labelsMissing = !labels;
  for (const auto& point : grid.points) scan.counts.invalid += !PointGrid::isReturn(point);
  if (m_options.flyingPixelThreshold > 0)
    scan.counts.flying = removeFlyingPixels(grid, m_options.flyingPixelThreshold);
  const auto pixels = choosePixels(grid, m_options.decimation);
  scan.cloud.points.reserve(pixels.size());
  for (const std::size_t pixel : pixels) scan.cloud.points.push_back(grid.points[pixel]);
  if (labels) addLabels(observation, grid, pixels, std::move(*labels), scan);
  if (!m_options.emptyCarves) return;
  scan.empty = emptyPixels(observation, *m_rays, m_options.decimation);
  scan.emptyFrom = static_cast<double>(observation.maxRange);
}

semantic_types::LabeledCloud LabeledScan::withEmpty() const {
  semantic_types::LabeledCloud all = cloud;
  all.points.insert(all.points.end(), empty.begin(), empty.end());
  if (!cloud.classes.empty()) all.classes.resize(all.size(), kNoClass);
  if (!cloud.probabilities.empty())
    all.probabilities.resize(cloud.probabilities.size() / cloud.size() * all.size(), 0);
  return all;
}

void LabeledScan::countLabels() {
  counts.labeled = 0;
  if (cloud.probabilities.empty()) {
    for (const ClassId id : cloud.classes) counts.labeled += id != kNoClass;
    return;
  }
  const std::size_t k = cloud.probabilities.size() / cloud.size();
  for (auto row = cloud.probabilities.begin(); row != cloud.probabilities.end(); row += k)
    counts.labeled += std::any_of(row, row + k, [](float p) { return p > 0; });
}

std::uint32_t rawIdOf(double number) {
  if (!(number >= 0 && number <= 4294967295.0 && number == std::floor(number)))
    throw std::invalid_argument("label " + strict_files::textOf(number) + " is no class id");
  return static_cast<std::uint32_t>(number);
}

ClassId classOfRawId(std::uint32_t rawId, const ClassTable& table) {
  return rawId == 0 && table.folds().count(0) == 0 ? kNoClass : table.fromRaw(rawId);
}

std::vector<float> timesOfPoints(const std::vector<double>& seconds) {
  constexpr double kLongest = 1;  // s
  const bool areTimes =
      std::all_of(seconds.begin(), seconds.end(), [](double t) { return std::abs(t) <= kLongest; });
  return areTimes ? std::vector<float>(seconds.begin(), seconds.end()) : std::vector<float>();
}

namespace {

/** Class of the table for each class of an observation. */
class ClassTranslation {
 public:
  ClassTranslation(const ClassTable& table, const std::vector<std::string>& names)
      : m_table(table), m_names(names) {}

  /** \throw std::invalid_argument the table lacks the class, and takes that for an error. */
  ClassId operator()(ClassId id) {
    if (id == kNoClass) return kNoClass;
    auto& known = m_known[id];
    if (!known) known = lookUp(id);
    return *known;
  }

 private:
  ClassId lookUp(ClassId id) const {
    const bool named = !m_names.empty();
    if (named && id > m_names.size())
      throw std::invalid_argument("its class " + std::to_string(id) + " has no name");
    if (!named && m_table.contains(id)) return id;
    if (named)
      if (const auto found = m_table.find(m_names[id - 1])) return *found;
    if (m_table.unknownRawId() == ClassTable::UnknownRawId::NoClass) return kNoClass;
    throw std::invalid_argument(named ? "its class '" + m_names[id - 1] + "' is not in the table"
                                      : "its class " + std::to_string(id) + " is not one of 1.." +
                                            std::to_string(m_table.size()));
  }

  const ClassTable& m_table;
  const std::vector<std::string>& m_names;
  std::optional<ClassId> m_known[256];
};

/** Appends one point's class probabilities in the order of the table. */
void appendTranslated(const float* from, std::size_t classes, ClassTranslation& translate,
                      std::size_t tableSize, std::vector<float>& to) {
  const std::size_t row = to.size();
  to.resize(row + tableSize, 0.f);
  for (std::size_t k = 0; k < classes; ++k) {
    const ClassId id = from[k] > 0 ? translate(static_cast<ClassId>(k + 1)) : kNoClass;
    if (id != kNoClass) to[row + id - 1] += from[k];
  }
}

/** None: there are no colors, or they are those of a photograph. */
std::vector<ClassId> classesOf(const std::vector<semantic_types::Color>& colors,
                               const ClassTable& table) {
  std::vector<ClassId> classes;
  bool anyClass = false;
  for (const semantic_types::Color& color : colors) {
    const auto id = table.find(color);
    if (!id && !(color == semantic_types::Color{0, 0, 0})) return {};
    classes.push_back(id.value_or(kNoClass));
    anyClass = anyClass || id;
  }
  return anyClass ? classes : std::vector<ClassId>();
}

}  // namespace

void ScanConverter::addNamedCloud(NamedCloud named, LabeledScan& scan) const {
  for (const std::uint32_t id : named.rawIds)
    named.cloud.classes.push_back(classOfRawId(id, m_table));
  if (named.cloud.classes.empty() && named.cloud.probabilities.empty())
    named.cloud.classes = classesOf(named.colors, m_table);
  const auto& from = named.cloud;
  auto& to = scan.cloud;
  ClassTranslation translate(m_table, named.classNames);
  const std::size_t classes = from.empty() ? 0 : from.probabilities.size() / from.size();
  if (!named.classNames.empty() && classes > named.classNames.size())
    throw std::invalid_argument("probabilities of " + std::to_string(classes) +
                                " classes, but names of " +
                                std::to_string(named.classNames.size()));
  to.points.reserve(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (!PointGrid::isReturn(from.points[i])) continue;
    if (static_cast<double>(from.points[i].norm()) >= named.emptyFrom) {
      if (m_options.emptyCarves) scan.empty.push_back(kBeyond * from.points[i]);
      continue;
    }
    to.points.push_back(from.points[i]);
    if (!named.times.empty()) scan.times.push_back(named.times.at(i));
    if (!from.classes.empty()) to.classes.push_back(translate(from.classes.at(i)));
    if (classes > 0)
      appendTranslated(&from.probabilities[i * classes], classes, translate, m_table.size(),
                       to.probabilities);
  }
  if (m_options.emptyCarves) scan.emptyFrom = named.emptyFrom;
  scan.counts.invalid = from.size() - to.size();
  if (!from.classes.empty() || classes > 0) m_options.labels.apply(m_table.size(), {}, to);
}

namespace {

/** Looking along x with z up becomes looking along z with y down. */
CPose3D opticalFrame() {
  using mrpt::DEG2RAD;
  return {0, 0, 0, DEG2RAD(-90.0), 0, DEG2RAD(-90.0)};
}

std::string size(int cols, int rows) { return std::to_string(cols) + " x " + std::to_string(rows); }

void checkSize(const LabelImage& labels, int rows, int cols, const char* what) {
  if (labels.pictureRows() == rows && labels.pictureCols() == cols) return;
  throw std::invalid_argument(labels.origin + ": the label image has " +
                              size(labels.pictureCols(), labels.pictureRows()) + " pixels, " +
                              what + " " + size(cols, rows));
}

bool isAligned(const CObservation3DRangeScan& o) {
  return o.doDepthAndIntensityCamerasCoincide() && o.cameraParams == o.cameraParamsIntensity;
}

/** Each point takes the label of the pixel it was made of. */
void labelInPlace(const PointGrid& grid, const std::vector<std::size_t>& pixels,
                  const LabelImage& labels, PointLabels& to) {
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto cell = labels.cellAt(pixels[i] % grid.cols, pixels[i] / grid.cols);
    if (cell) to.take(i, labels, *cell);
  }
}

/** Each point takes the label of the pixel at which the camera sees it. */
void labelByProjection(const PointGrid& grid, const std::vector<std::size_t>& pixels,
                       const LabeledPicture& picture, double parallax, PointLabels& to) {
  const auto T_camera_sensor = toEigen(picture.T_sensor_camera).inverse();
  const auto seen = visiblePixels(grid.points, T_camera_sensor, picture.camera, parallax);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Eigen::Vector2f& pixel = seen[pixels[i]];
    if (const auto cell = picture.labels.cellAt(pixel.x(), pixel.y()))
      to.take(i, picture.labels, *cell);
  }
}

}  // namespace

void ScanConverter::addLabels(const CObservation3DRangeScan& observation, const PointGrid& grid,
                              const std::vector<std::size_t>& pixels, LabelImage labels,
                              LabeledScan& scan) {
  const bool ofColor = labels.view == LabelImage::View::Color && !isAligned(observation);
  LabeledPicture picture;
  picture.camera = ofColor ? observation.cameraParamsIntensity : observation.cameraParams;
  picture.T_sensor_camera = ofColor ? observation.relativePoseIntensityWRTDepth : opticalFrame();
  picture.labels = std::move(labels);
  PointLabels taken(pixels.size());
  if (ofColor) {
    checkSize(picture.labels, int(picture.camera.nrows), int(picture.camera.ncols),
              "the color camera is calibrated for");
    labelByProjection(grid, pixels, picture, m_options.occlusionParallax, taken);
  } else {
    checkSize(picture.labels, grid.rows, grid.cols, "the depth image");
    labelInPlace(grid, pixels, picture.labels, taken);
  }
  const auto confidences = taken.moveTo(scan.cloud);
  m_options.labels.apply(m_table.size(), confidences, scan.cloud);
  if (!m_keepPictures) return;
  if (observation.hasIntensityImage && (ofColor || isAligned(observation)))
    picture.image = observation.intensityImage.makeDeepCopy();
  scan.pictures.push_back(std::move(picture));
}

}  // namespace labeled_cloud
