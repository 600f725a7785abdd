#include "PointLabels.h"

#include <labeled_cloud/CObservationLabeledCloud.h>
#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <cmath>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace labeled_cloud {

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

Points pointsOf(const CObservationPointCloud& observation) {
  if (!observation.pointcloud) throw std::invalid_argument("it holds no point cloud");
  const auto& cloud = *observation.pointcloud;
  return zip(cloud.getPointsBufferRef_x(), cloud.getPointsBufferRef_y(),
             cloud.getPointsBufferRef_z());
}

Points pointsOf(const CObservation2DRangeScan& scan) {
  const std::size_t beams = scan.getScanSize();
  const double turn = scan.rightToLeft ? 1 : -1;
  Points points(beams, Eigen::Vector3f::Zero());
  for (std::size_t i = 0; i < beams; ++i) {
    const double range = scan.getScanRange(i);
    if (!scan.getScanRangeValidity(i) || range >= scan.maxRange) continue;
    const double share = beams == 1 ? 0 : double(i) / double(beams - 1) - 0.5;
    const double angle = turn * scan.aperture * share;
    points[i] = Eigen::Vector3d(range * std::cos(angle), range * std::sin(angle), 0).cast<float>();
  }
  return points;
}

std::vector<Color> colorsOf(const CObservation&) { return {}; }

std::vector<Color> colorsOf(const CObservationPointCloud& observation) {
  std::vector<Color> colors;
  const auto* cloud =
      dynamic_cast<const mrpt::maps::CColouredPointsMap*>(observation.pointcloud.get());
  const auto byte = [](float share) { return static_cast<std::uint8_t>(std::lround(255 * share)); };
  for (std::size_t i = 0; cloud && i < cloud->size(); ++i) {
    float r = 0, g = 0, b = 0;
    cloud->getPointColor(i, r, g, b);
    colors.push_back({byte(r), byte(g), byte(b)});
  }
  return colors;
}

/** An observation that says where something is, and perhaps in which color. */
template <typename Observation>
NamedCloud cloudOf(const Observation& observation) {
  NamedCloud named;
  named.cloud.points = pointsOf(observation);
  named.colors = colorsOf(observation);
  return named;
}

NamedCloud cloudOf(const CObservationLabeledCloud& observation) {
  observation.validate();
  return {observation.cloud, observation.classNames, {}, observation.times};
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
