#include "UnlabeledPoints.h"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace labeled_cloud {

using mrpt::obs::CObservation;
using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservationPointCloud;
using mrpt::obs::CObservationVelodyneScan;
using Points = std::vector<Eigen::Vector3f>;

namespace {

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

Points pointsOf(const CObservationVelodyneScan& observation) {
  CObservationVelodyneScan unpacked;
  const bool ready = observation.point_cloud.size() > 0;
  if (!ready) unpacked = observation, unpacked.generatePointCloud();
  const auto& cloud = ready ? observation.point_cloud : unpacked.point_cloud;
  return zip(cloud.x, cloud.y, cloud.z);
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

template <typename Observation>
const Observation* as(const CObservation& observation) {
  return dynamic_cast<const Observation*>(&observation);
}

}  // namespace

Points unlabeledPoints(const CObservation& observation) {
  if (const auto* cloud = as<CObservationPointCloud>(observation)) return pointsOf(*cloud);
  if (const auto* packets = as<CObservationVelodyneScan>(observation)) return pointsOf(*packets);
  if (const auto* scan = as<CObservation2DRangeScan>(observation)) return pointsOf(*scan);
  throw std::invalid_argument("it holds no points");
}

bool hasUnlabeledPoints(const CObservation& observation) {
  return as<CObservationPointCloud>(observation) || as<CObservationVelodyneScan>(observation) ||
         as<CObservation2DRangeScan>(observation);
}

}  // namespace labeled_cloud
