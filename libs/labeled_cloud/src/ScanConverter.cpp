#include <labeled_cloud/LabelImage.h>
#include <labeled_cloud/ScanConverter.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "ObservationName.h"
#include "PointGrid.h"
#include "PointSources.h"

namespace labeled_cloud {

using mrpt::obs::CObservation;
using mrpt::obs::CObservation3DRangeScan;
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

}  // namespace

void ScanConverterOptions::describe(strict_files::OptionList& list) {
  using strict_files::atLeast;
  list.add(
      "decimation", decimation, "pixels", atLeast(1),
      "depth images: one point, the nearest, for a block of so many squared; 2 to 4 for VGA and "
      "more");
  list.add("flying_pixel_threshold", flyingPixelThreshold, "", atLeast(0).below(1),
           "depth images: leaves out pixels that hang in the air at depth edges, farther from both "
           "sides than this share of their depth (0.02); 0: keeps all");
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
  scan.timestamp = observation.timestamp;
  scan.sensorLabel = observation.sensorLabel;
  if (source)
    addNamedCloud(source->read(observation), scan);
  else
    addRangeScan(*range, scan);
  scan.counts.points = scan.cloud.size();
  scan.countLabels();
  return scan;
} catch (const std::exception& e) {
  throw std::runtime_error(nameOf(observation) + ": " + strict_files::messageOf(e));
}

void ScanConverter::addRangeScan(const CObservation3DRangeScan& observation, LabeledScan& scan) {
  if (!observation.hasRangeImage && !observation.hasPoints3D)
    throw std::invalid_argument("it has neither a range image nor 3D points");
  const mrpt::img::TCamera& camera = observation.cameraParams;
  if (double(camera.nrows) * camera.ncols > kMostPixels)
    throw std::invalid_argument("a camera of " + std::to_string(camera.ncols) + " x " +
                                std::to_string(camera.nrows) + " pixels; 40 million are allowed");
  if (observation.hasRangeImage) checkSize(observation);
  if (observation.hasRangeImage && !(m_rays && m_rays->isFor(camera)))
    m_rays = std::make_unique<PixelRays>(camera);
  PointGrid grid =
      observation.hasRangeImage ? unproject(observation, *m_rays) : gridOfPoints(observation);

  auto labels = m_labeler->label(observation);
  scan.labelsMissing = !labels;
  for (const auto& point : grid.points) scan.counts.invalid += !PointGrid::isReturn(point);
  if (m_options.flyingPixelThreshold > 0)
    scan.counts.flying = removeFlyingPixels(grid, m_options.flyingPixelThreshold);
  const auto pixels = choosePixels(grid, m_options.decimation);
  scan.cloud.points.reserve(pixels.size());
  for (const std::size_t pixel : pixels) scan.cloud.points.push_back(grid.points[pixel]);
  if (labels) addLabels(observation, grid, pixels, std::move(*labels), scan);
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

}  // namespace labeled_cloud
