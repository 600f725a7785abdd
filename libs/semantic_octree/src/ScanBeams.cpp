#include <semantic_octree/store/ScanBeams.h>

#include <strict_files/TextFile.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace semantic_octree {

using semantic_types::LabeledCloud;

ScanBeams::ScanBeams(const LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor,
                     double resolution, const InsertionOptions& options)
    : m_cloud(cloud),
      m_origin(inVoxels(T_map_sensor.translation().x(), resolution),
               inVoxels(T_map_sensor.translation().y(), resolution),
               inVoxels(T_map_sensor.translation().z(), resolution)),
      m_rotation(T_map_sensor.linear() / resolution),
      m_maxRange(options.maxRange > 0 ? options.maxRange : std::numeric_limits<double>::max()),
      m_minRange2(options.minRange * options.minRange),
      m_maxRange2(std::min(m_maxRange * m_maxRange, std::numeric_limits<double>::max())) {
  if (!T_map_sensor.matrix().allFinite())
    throw std::invalid_argument("the sensor's pose has numbers that are not finite");
  if (!insideMap(m_origin)) {
    const Eigen::Vector3d sensor = T_map_sensor.translation();
    std::ostringstream what;
    const strict_files::ClassicNumbers classic(what);
    what << "sensor at (" << sensor.x() << ", " << sensor.y() << ", " << sensor.z()
         << ") m is outside the map, which reaches " << kKeyOfOrigin * resolution
         << " m from its origin";
    throw std::out_of_range(what.str());
  }
  std::size_t numBeams[5] = {};
  Eigen::Array3d lowest = m_origin, highest = m_origin;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Beam b = beam(i);
    ++numBeams[static_cast<int>(b.kind)];
    if (!b.isUsed()) continue;
    lowest = lowest.min(b.end);
    highest = highest.max(b.end);
  }
  m_lowest = voxelOf(lowest);
  m_highest = voxelOf(highest);
  const auto number = [&](Beam::Kind kind) { return numBeams[static_cast<int>(kind)]; };
  m_report.points = cloud.size();
  m_report.skippedNotFinite = number(Beam::Kind::NotFinite);
  m_report.skippedNear = number(Beam::Kind::Near);
  m_report.skippedOutside = number(Beam::Kind::Outside);
  m_report.beyondRange = number(Beam::Kind::Clipped);
}

}  // namespace semantic_octree
