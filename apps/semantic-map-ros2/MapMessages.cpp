#include "MapMessages.h"

#include <map_operations/MapOperations.h>
#include <octomap/OcTree.h>
#include <semantic_types/ClassTable.h>

#include <sstream>
#include <utility>

namespace semantic_map_ros2 {

using ros2::Stamp;
using semantic_octree::SemanticOcTree;

namespace {

constexpr std::int32_t kCubeList = 6, kAdd = 0, kDelete = 2;

/** A block has ten bits an axis. */
std::int32_t idOf(std::uint64_t block) {
  return static_cast<std::int32_t>((block >> 32 & 1023) << 20 | (block >> 16 & 1023) << 10 |
                                   (block & 1023));
}

}  // namespace

MapMessages::MapMessages(ros2::Node& node, SemanticOcTree& map, std::string frame)
    : m_map(map),
      m_frame(std::move(frame)),
      m_voxels(map),
      m_writesMarkers(node, "~/markers", {true, false, 100}),
      m_writesPoints(node, "~/occupied", {true, true, 1}),
      m_writesOctomap(node, "~/octomap", {true, true, 1}) {}

void MapMessages::publish(Stamp stamp) {
  if (m_writesMarkers.isRead() || m_writesPoints.isRead()) m_changed.merge(m_voxels.follow());
  publishMarkers(stamp);
  if (m_writesPoints.isRead()) publishPoints(stamp);
  if (m_writesOctomap.isRead()) publishOctomap(stamp);
}

void MapMessages::publishMarkers(Stamp stamp) {
  if (m_writesMarkers.hasNewReader()) {
    m_shown.clear();  // it shows nothing yet
    for (const auto& [block, tiles] : m_voxels.blocks()) m_changed.insert(block);
  }
  if (!m_writesMarkers.isRead() || m_changed.empty()) return;
  m_markers.clear(), m_cubes.clear();
  const ros2::Header header = ros2::headerOf(stamp, m_frame);
  const auto shown = m_shown;
  for (const std::uint64_t block : m_changed) addMarkers(block, header);
  ros2::MarkerArray message{};
  ros2::refer(message.markers, m_markers);
  if (m_writesMarkers.write(message))
    m_changed.clear();
  else
    m_shown = shown;  // it is tried again
}

void MapMessages::addMarkers(std::uint64_t block, const ros2::Header& header) {
  std::set<ClassId> before = std::exchange(m_shown[block], {});
  const auto& blocks = m_voxels.blocks();
  if (const auto tiles = blocks.find(block); tiles != blocks.end())
    for (const auto& [tile, voxels] : tiles->second)
      for (const OccupiedVoxels::Voxel& voxel : voxels) {
        const auto [x, y, z] = m_voxels.centerOf(voxel);
        m_cubes[{block, voxel.classId}].push_back({x, y, z});
        m_shown[block].insert(voxel.classId);
      }
  before.insert(m_shown[block].begin(), m_shown[block].end());
  for (const ClassId id : before) {
    const auto color = semantic_types::colorOf(id, m_map.classes());
    const double edge = m_map.getResolution();
    ros2::Marker marker{};
    marker.header = header;
    marker.ns = ros2::textOf(m_map.classes().name(id));
    marker.id = idOf(block);
    marker.type = kCubeList;
    marker.pose.orientation.w = 1;
    marker.scale = {edge, edge, edge};
    marker.color = {float(color.r) / 255, float(color.g) / 255, float(color.b) / 255, 1};
    const bool isThere = m_shown[block].count(id) > 0;
    marker.action = isThere ? kAdd : kDelete;
    if (isThere) ros2::refer(marker.points, m_cubes[{block, id}]);
    m_markers.push_back(marker);
  }
  if (m_shown[block].empty()) m_shown.erase(block);
}

void MapMessages::publishPoints(Stamp stamp) {
  std::vector<PackedPoint> points = m_voxels.points();
  std::vector<ros2::PointField> fields;
  for (const auto& [name, type] : fieldsOfPoint())
    fields.push_back({ros2::textOf(name), 4 * std::uint32_t(fields.size()), type, 1});
  ros2::PointCloud2 message{};
  message.header = ros2::headerOf(stamp, m_frame);
  message.height = 1, message.width = static_cast<std::uint32_t>(points.size());
  ros2::refer(message.fields, fields);
  message.point_step = sizeof(PackedPoint);
  message.row_step = message.point_step * message.width;
  message.is_dense = true;
  message.data._length = message.data._maximum = message.row_step;
  message.data._buffer = reinterpret_cast<std::uint8_t*>(points.data());
  m_writesPoints.write(message);
}

void MapMessages::publishOctomap(Stamp stamp) {
  std::ostringstream bytes;
  const auto tree = toOcTree(m_map);
  tree->toMaxLikelihood();
  tree->writeBinaryData(bytes);
  std::string data = bytes.str();
  const std::string id = "OcTree";
  ros2::Octomap message{};
  message.header = ros2::headerOf(stamp, m_frame);
  message.binary = true;
  message.id = ros2::textOf(id);
  message.resolution = m_map.getResolution();
  message.data._length = message.data._maximum = static_cast<std::uint32_t>(data.size());
  message.data._buffer = reinterpret_cast<std::uint8_t*>(data.data());
  m_writesOctomap.write(message);
}

}  // namespace semantic_map_ros2
