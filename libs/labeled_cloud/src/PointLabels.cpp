#include "PointLabels.h"

#include <labeled_cloud/CObservationLabeledCloud.h>
#include <mrpt/maps/CPointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt_compat/Maps.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace labeled_cloud {

using mrpt::maps::CPointsMap;
using mrpt::obs::CObservation;
using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservationPointCloud;
using mrpt::obs::CObservationVelodyneScan;
using semantic_types::Color;

namespace {

using Points = std::vector<Eigen::Vector3f>;

template <typename Xs>
Points zip(const Xs& xs, const Xs& ys, const Xs& zs) {
  if (ys.size() != xs.size() || zs.size() != xs.size())
    throw std::invalid_argument("its points have " + std::to_string(xs.size()) + " x, " +
                                std::to_string(ys.size()) + " y and " + std::to_string(zs.size()) +
                                " z");
  Points points;
  points.reserve(xs.size());
  for (std::size_t i = 0; i < xs.size(); ++i) points.emplace_back(xs[i], ys[i], zs[i]);
  return points;
}

NamedCloud cloudOf(const CObservation2DRangeScan& scan) {
  const std::size_t beams = scan.getScanSize();
  const double turn = scan.rightToLeft ? 1 : -1;
  NamedCloud named;
  named.emptyFrom = scan.maxRange;
  Points& points = named.cloud.points;
  points.assign(beams, Eigen::Vector3f::Zero());
  for (std::size_t i = 0; i < beams; ++i) {
    const bool isEmpty = scan.getScanRange(i) >= scan.maxRange;
    const double range = isEmpty ? 2 * scan.maxRange : scan.getScanRange(i);
    if (!isEmpty && !scan.getScanRangeValidity(i)) continue;
    const double share = beams == 1 ? 0 : double(i) / double(beams - 1) - 0.5;
    const double angle = turn * scan.aperture * share;
    points[i] = Eigen::Vector3d(range * std::cos(angle), range * std::sin(angle), 0).cast<float>();
  }
  return named;
}

/** Numbers for each of so many points, or none.
 * \throw std::invalid_argument some points have none: who filled the cloud forgot the field */
std::vector<double> field(const CPointsMap& cloud, const std::string& name) {
  auto numbers = mrpt_compat::pointField(cloud, name);
  if (numbers.empty() || numbers.size() == cloud.size()) return numbers;
  throw std::invalid_argument("its field '" + name + "' has " + std::to_string(numbers.size()) +
                              " values for " + std::to_string(cloud.size()) + " points");
}

std::vector<Color> colorsOf(const CPointsMap& cloud) {
  const auto colors = [&cloud](const char* r, const char* g, const char* b, double scale) {
    const auto rs = field(cloud, r), gs = field(cloud, g), bs = field(cloud, b);
    const auto byte = [scale](double value) {
      return static_cast<std::uint8_t>(std::lround(std::clamp(scale * value, 0.0, 255.0)));
    };
    std::vector<Color> all;
    if (!rs.empty() && !gs.empty() && !bs.empty())
      for (std::size_t i = 0; i < rs.size(); ++i)
        all.push_back({byte(rs[i]), byte(gs[i]), byte(bs[i])});
    return all;
  };
  auto bytes = colors("color_r", "color_g", "color_b", 1);
  return bytes.empty() ? colors("color_rf", "color_gf", "color_bf", 255) : bytes;
}

std::vector<std::uint32_t> labelsOf(const CPointsMap& cloud) {
  std::vector<std::uint32_t> labels;
  for (const double label : field(cloud, "label")) labels.push_back(rawIdOf(label));
  return labels;
}

NamedCloud cloudOf(const CObservationPointCloud& observation) {
  if (!observation.pointcloud) throw std::invalid_argument("it holds no point cloud");
  const CPointsMap& cloud = *observation.pointcloud;
  NamedCloud named;
  named.cloud.points =
      zip(cloud.getPointsBufferRef_x(), cloud.getPointsBufferRef_y(), cloud.getPointsBufferRef_z());
  named.colors = colorsOf(cloud);
  named.rawIds = labelsOf(cloud);
  named.times = timesOfPoints(field(cloud, "t"));
  return named;
}

NamedCloud cloudOf(const CObservationLabeledCloud& observation) {
  observation.validate();
  return {observation.cloud, observation.classNames, {}, {},
          observation.times, observation.emptyFrom};
}

NamedCloud cloudOf(const CObservationVelodyneScan& observation) {
  CObservationVelodyneScan unpacked;
  const bool ready = observation.point_cloud.size() > 0;
  if (!ready) {
    CObservationVelodyneScan::TGeneratePointCloudParameters withTimes;
    withTimes.generatePerPointTimestamp = true;
    unpacked = observation;
    unpacked.generatePointCloud(withTimes);
  }
  const auto& cloud = ready ? observation.point_cloud : unpacked.point_cloud;
  NamedCloud named;
  named.cloud.points = zip(cloud.x, cloud.y, cloud.z);
  for (const auto& time : cloud.timestamp)
    named.times.push_back(
        static_cast<float>(mrpt::system::timeDifference(observation.timestamp, time)));
  if (named.times.size() != named.cloud.size()) named.times.clear();
  return named;
}

template <typename Observation>
class SourceOf final : public PointSource {
 public:
  bool accepts(const CObservation& observation) const override { return as(observation); }
  NamedCloud read(const CObservation& observation) const override {
    return cloudOf(*as(observation));
  }

 private:
  static const Observation* as(const CObservation& observation) {
    return dynamic_cast<const Observation*>(&observation);
  }
};

struct Registry {
  std::mutex mutex;
  std::vector<std::shared_ptr<const PointSource>> sources{
      std::make_shared<SourceOf<CObservation2DRangeScan>>(),
      std::make_shared<SourceOf<CObservationVelodyneScan>>(),
      std::make_shared<SourceOf<CObservationPointCloud>>(),
      std::make_shared<SourceOf<CObservationLabeledCloud>>()};
};

Registry& registry() {
  static Registry all;
  return all;
}

}  // namespace

void addPointSource(std::shared_ptr<const PointSource> source) {
  const std::lock_guard<std::mutex> lock(registry().mutex);
  registry().sources.push_back(std::move(source));
}

std::shared_ptr<const PointSource> pointSourceOf(const CObservation& observation) {
  const std::lock_guard<std::mutex> lock(registry().mutex);
  const auto& sources = registry().sources;
  for (auto source = sources.rbegin(); source != sources.rend(); ++source)
    if ((*source)->accepts(observation)) return *source;
  return nullptr;
}

}  // namespace labeled_cloud
