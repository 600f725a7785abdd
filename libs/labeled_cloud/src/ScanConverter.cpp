#include <labeled_cloud/EmbeddedLabels.h>
#include <labeled_cloud/MrptMessage.h>
#include <labeled_cloud/ScanConverter.h>

#include <algorithm>
#include <stdexcept>

#include "PointGrid.h"
#include "UnlabeledPoints.h"

namespace labeled_cloud {

using mrpt::obs::CObservation;
using mrpt::obs::CObservation3DRangeScan;
using semantic_octree::ClassId;
using semantic_octree::ClassTable;
using semantic_octree::kNoClass;

namespace {

/** Holds what an observation stores in files of its own in memory for a while. */
class LoadedObservation {
 public:
  explicit LoadedObservation(const CObservation& observation) : m_observation(observation) {
    m_observation.load();
  }
  ~LoadedObservation() { m_observation.unload(); }
  LoadedObservation(const LoadedObservation&) = delete;
  LoadedObservation& operator=(const LoadedObservation&) = delete;

 private:
  const CObservation& m_observation;
};

template <typename Observation>
bool is(const CObservation& observation) {
  return dynamic_cast<const Observation*>(&observation) != nullptr;
}

std::string nameOf(const CObservation& o) {
  return std::string(o.GetRuntimeClass()->className) + " '" + o.sensorLabel + "' at " +
         std::to_string(mrpt::Clock::toDouble(o.timestamp)) + " s";
}

void checkSize(const LabelImage& labels, const PointGrid& grid) {
  if (labels.rows == grid.rows && labels.cols == grid.cols) return;
  throw std::invalid_argument(labels.origin + ": the label image has " +
                              std::to_string(labels.cols) + " x " + std::to_string(labels.rows) +
                              " pixels, the depth image " + std::to_string(grid.cols) + " x " +
                              std::to_string(grid.rows));
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

void addPoints(const PointGrid& grid, const LabelImage* labels, int decimation, LabeledScan& scan) {
  const auto blocks = [decimation](int n) {
    return std::size_t((n + decimation - 1) / decimation);
  };
  scan.cloud.points.reserve(blocks(grid.rows) * blocks(grid.cols));
  if (labels) scan.cloud.classes.reserve(scan.cloud.points.capacity());
  for (int row = 0; row < grid.rows; row += decimation)
    for (int col = 0; col < grid.cols; col += decimation) {
      const auto pixel = nearestOfBlock(grid, row, col, decimation);
      if (!pixel) continue;
      scan.cloud.points.push_back(grid.points[*pixel]);
      if (labels) scan.cloud.classes.push_back(labels->classes[*pixel]);
    }
}

void addUnlabeled(const CObservation& observation, LabeledScan& scan) {
  auto points = unlabeledPoints(observation);
  const std::size_t read = points.size();
  points.erase(std::remove_if(points.begin(), points.end(),
                              [](const auto& p) { return !PointGrid::isReturn(p); }),
               points.end());
  scan.counts.invalid = read - points.size();
  scan.cloud.points = std::move(points);
}

void countPoints(LabeledScan& scan) {
  const auto& cloud = scan.cloud;
  scan.counts.points = cloud.size();
  if (cloud.probabilities.empty()) {
    for (const ClassId id : cloud.classes) scan.counts.labeled += id != kNoClass;
    return;
  }
  const std::size_t k = cloud.probabilities.size() / cloud.size();
  for (auto row = cloud.probabilities.begin(); row != cloud.probabilities.end(); row += k)
    scan.counts.labeled += std::any_of(row, row + k, [](float p) { return p > 0; });
}

}  // namespace

void ScanConverterOptions::validate() const {
  if (decimation < 1)
    throw std::invalid_argument("scan converter: decimation = " + std::to_string(decimation) +
                                ", must be 1 or more");
  if (!(flyingPixelThreshold >= 0 && flyingPixelThreshold < 1))
    throw std::invalid_argument("scan converter: flyingPixelThreshold = " +
                                std::to_string(flyingPixelThreshold) + ", must be in [0, 1)");
}

ScanConverter::ScanConverter(const ClassTable& table, const ScanConverterOptions& options,
                             std::shared_ptr<ImageLabeler> labeler)
    : m_table(table), m_options(options), m_labeler(std::move(labeler)) {
  m_options.validate();
  if (!m_labeler) m_labeler = std::make_shared<EmbeddedLabels>(table);
}

ScanConverter::~ScanConverter() = default;

bool ScanConverter::accepts(const CObservation& observation) {
  return is<CObservation3DRangeScan>(observation) || is<CObservationLabeledCloud>(observation) ||
         hasUnlabeledPoints(observation);
}

std::optional<LabeledScan> ScanConverter::convert(const CObservation& observation) try {
  if (!accepts(observation)) return std::nullopt;
  const LoadedObservation loaded(observation);
  LabeledScan scan;
  observation.getSensorPose(scan.T_robot_sensor);
  scan.timestamp = observation.timestamp;
  scan.sensorLabel = observation.sensorLabel;
  if (const auto* range = dynamic_cast<const CObservation3DRangeScan*>(&observation))
    addRangeScan(*range, scan);
  else if (const auto* labeled = dynamic_cast<const CObservationLabeledCloud*>(&observation))
    addLabeledCloud(*labeled, scan);
  else
    addUnlabeled(observation, scan);
  countPoints(scan);
  return scan;
} catch (const std::exception& e) {
  throw std::runtime_error(nameOf(observation) + ": " + messageOf(e));
}

void ScanConverter::addRangeScan(const CObservation3DRangeScan& observation, LabeledScan& scan) {
  if (!observation.hasRangeImage && !observation.hasPoints3D)
    throw std::invalid_argument("it has neither a range image nor 3D points");
  if (observation.hasRangeImage && !(m_rays && m_rays->isFor(observation.cameraParams)))
    m_rays = std::make_unique<PixelRays>(observation.cameraParams);
  PointGrid grid =
      observation.hasRangeImage ? unproject(observation, *m_rays) : gridOfPoints(observation);

  const auto labels = m_labeler->label(observation);
  if (labels) checkSize(*labels, grid);
  scan.labelsMissing = !labels;
  for (const auto& point : grid.points) scan.counts.invalid += !PointGrid::isReturn(point);
  if (m_options.flyingPixelThreshold > 0)
    scan.counts.flying = removeFlyingPixels(grid, m_options.flyingPixelThreshold);
  addPoints(grid, labels ? &*labels : nullptr, m_options.decimation, scan);
}

}  // namespace labeled_cloud
