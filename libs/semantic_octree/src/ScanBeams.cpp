#include "ScanBeams.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace semantic_octree {

using semantic_types::LabeledCloud;
namespace {

bool insideMap(const Eigen::Array3d& u) {
  return (u >= -kKeyOfOrigin).all() && (u < kKeyOfOrigin).all();
}

VoxelIndex voxelOf(const Eigen::Array3d& u) {
  return {floorOf(u.x()), floorOf(u.y()), floorOf(u.z())};
}

}  // namespace

void ScanBeams::compute(const LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor,
                        double resolution, const InsertionOptions& options) {
  const Eigen::Vector3d sensor = T_map_sensor.translation();
  origin = sensor.array() / resolution;
  if (!T_map_sensor.matrix().allFinite() || !insideMap(origin)) {
    std::ostringstream what;
    what << "sensor at (" << sensor.x() << ", " << sensor.y() << ", " << sensor.z()
         << ") m is outside the map, which reaches " << kKeyOfOrigin * resolution
         << " m from its origin";
    throw std::out_of_range(what.str());
  }
  report = InsertionReport();
  report.points = cloud.size();
  ends.clear();
  lowest = highest = voxelOf(origin);
  const Eigen::Matrix3d rotation = T_map_sensor.linear() / resolution;
  const double maxRange = options.maxRange > 0 ? options.maxRange : HUGE_VAL;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d p = cloud.points[i].cast<double>();
    const double range2 = p.squaredNorm();
    if (!std::isfinite(range2)) {
      ++report.skippedNotFinite;
      continue;
    }
    if (range2 < options.minRange * options.minRange) {
      ++report.skippedNear;
      continue;
    }
    const bool isReturn = range2 <= maxRange * maxRange;
    const double scale = isReturn ? 1.0 : maxRange / std::sqrt(range2);
    const Eigen::Array3d end = origin + (rotation * p).array() * scale;
    if (!insideMap(end)) {
      ++report.skippedOutside;
      continue;
    }
    report.beyondRange += !isReturn;
    ends.push_back({end, static_cast<std::uint32_t>(i), isReturn});
    const VoxelIndex voxel = voxelOf(end);
    lowest = lowest.min(voxel);
    highest = highest.max(voxel);
  }
}

}  // namespace semantic_octree
