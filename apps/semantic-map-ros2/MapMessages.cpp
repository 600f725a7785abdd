#include "MapMessages.h"

#include <map_operations/MapOperations.h>
#include <octomap/OcTree.h>
#include <semantic_types/ClassTable.h>

#include <sstream>
#include <stdexcept>
#include <utility>

namespace semantic_map_ros2 {

using ros2::Stamp;
using semantic_octree::SemanticOcTree;

namespace {

constexpr std::int32_t kCubeList = 6, kAdd = 0, kDelete = 2;
const std::string kOccupancy = "OcTree";  // OctoMap's, beside TreeTeller::kId

/** A block has ten bits an axis. */
std::int32_t idOf(std::uint64_t block) {
  return static_cast<std::int32_t>((block >> 32 & 1023) << 20 | (block >> 16 & 1023) << 10 |
                                   (block & 1023));
}

void write(ros2::Publication<ros2::Octomap>& to, const ros2::Header& header, const std::string& id,
           const SemanticOcTree& map, std::string bytes) {
  ros2::Octomap message{};
  message.header = header;
  message.binary = id == kOccupancy;
  message.id = ros2::textOf(id);
  message.resolution = map.getResolution();
  message.data._length = message.data._maximum = static_cast<std::uint32_t>(bytes.size());
  message.data._buffer = reinterpret_cast<std::uint8_t*>(bytes.data());
  to.write(message);
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
  write(m_writesOctomap, ros2::headerOf(stamp, m_frame), kOccupancy, m_map, bytes.str());
}

TreeMessages::TreeMessages(ros2::Node& node, semantic_octree::SemanticOcTree& map,
                           std::string frame)
    : m_map(map),
      m_frame(std::move(frame)),
      m_teller(map),
      m_writesChanges(node, "~/change", {true, false, TreeTeller::kMostChanges}),
      m_writesAll(node, "~/compressed", {true, false, 1}) {}

void TreeMessages::publish(ros2::Stamp stamp) {
  const auto writer = [&](ros2::Publication<ros2::Octomap>& to) {
    return [this, &to, stamp](std::string data) {
      write(to, ros2::headerOf(stamp, m_frame), TreeTeller::kId, m_map, std::move(data));
    };
  };
  const TreeTeller::Write all = writer(m_writesAll);
  m_teller.tell(isRead(), writer(m_writesChanges), isAsked() ? all : nullptr);
}

TreeReader::TreeReader(ros2::Node& node, const std::string& of)
    : m_node(node),
      m_allName(of + "/compressed"),
      m_hearsChanges(node, of + "/change", {true, false, TreeTeller::kMostChanges},
                     [this](const Message& message) { take(message, false); }) {}

void TreeReader::take(const Message& message, bool isAll) {
  const std::lock_guard<std::mutex> lock(m_mutex);
  m_isAnswered |= isAll;
  try {
    if (ros2::textOf(message->id) != TreeTeller::kId)
      throw std::runtime_error("a message of '" + ros2::textOf(message->id) + "', expected " +
                               TreeTeller::kId);
    m_isLacking = !m_copy.accept(
        {reinterpret_cast<const char*>(message->data._buffer), std::size_t(message->data._length)});
    m_hasMap |= !m_isLacking;
  } catch (const std::exception& e) {
    m_problem = e.what();
    m_isLacking = true;
  }
}

std::string TreeReader::look() {
  bool isToAsk, isDone;
  {
    const std::lock_guard<std::mutex> lock(m_mutex);
    isDone = !m_isLacking;
    isToAsk = m_isLacking && m_isAnswered;
    if (isToAsk) m_isAnswered = false;
  }
  if (isDone || isToAsk) m_hearsAll.reset();
  if (isToAsk)
    m_hearsAll.emplace(m_node, m_allName, ros2::Qos{true, false, 1},
                       [this](const Message& message) { take(message, true); });
  const std::lock_guard<std::mutex> lock(m_mutex);
  return std::exchange(m_problem, {});
}

bool TreeReader::isCurrent() const {
  const std::lock_guard<std::mutex> lock(m_mutex);
  return m_copy.isCurrent();
}

std::optional<semantic_octree::SemanticOcTree> TreeReader::map() const {
  const std::lock_guard<std::mutex> lock(m_mutex);
  if (!m_hasMap) return std::nullopt;
  return m_copy.map();
}

}  // namespace semantic_map_ros2
