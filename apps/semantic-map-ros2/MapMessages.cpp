#include "MapMessages.h"

#include <map_operations/MapOperations.h>
#include <octomap/OcTree.h>
#include <semantic_types/ClassTable.h>

#include <chrono>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace semantic_map_ros2 {

using ros2::Stamp;
using semantic_octree::SemanticOcTree;

namespace {

constexpr std::int32_t kCubeList = 6, kAdd = 0, kDelete = 2;
const std::string kOccupancy = "OcTree", kTree = "SemanticTree";  // OctoMap's id, and ours
constexpr int kMostChanges = 100;  // that wait for readers that are slow

constexpr int kBlock = 64;  // voxels; a block's number has ten bits an axis

int blockOf(const octomap::OcTreeKey& key) {
  return (key[0] / kBlock) << 20 | (key[1] / kBlock) << 10 | key[2] / kBlock;
}

/** The key of a block's lowest voxel, or of its highest. */
octomap::OcTreeKey cornerOf(int block, bool isHighest) {
  const auto key = [&](int number) {
    return octomap::key_type((number & 1023) * kBlock + (isHighest ? kBlock - 1 : 0));
  };
  return {key(block >> 20), key(block >> 10), key(block)};
}

/** A number for places and classes; never 0. */
std::size_t hashOf(const std::vector<PackedPoint>& points) {
  std::size_t hash = 1;
  for (const PackedPoint& p : points)
    for (const float value : {p.x, p.y, p.z, static_cast<float>(p.label)})
      hash = (hash ^ std::hash<float>()(value)) * 0x9E3779B97F4A7C15u + 1;
  return hash;
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
      m_follower(map.follow()),
      m_writesMarkers(node, "~/markers", {true, false, 100}),
      m_writesPoints(node, "~/occupied", {true, true, 1}),
      m_writesOctomap(node, "~/octomap", {true, true, 1}) {}

void MapMessages::publish(Stamp stamp) {
  if (m_writesMarkers.isRead()) publishMarkers(stamp);
  if (m_writesPoints.isRead()) publishPoints(stamp);
  if (m_writesOctomap.isRead()) publishOctomap(stamp);
}

void MapMessages::publishMarkers(Stamp stamp) {
  if (m_writesMarkers.hasNewReader()) {  // it shows nothing yet
    m_shown.clear();
    m_follower = m_map.follow();
  }
  const semantic_octree::TileChange change = m_follower.tiles();
  if (change.all)
    for (const auto& [block, shown] : m_shown) m_changed.insert(block);
  for (const octomap::OcTreeKey& tile : change.tiles) m_changed.insert(blockOf(tile));
  m_markers.clear(), m_cubes.clear();
  const ros2::Header header = ros2::headerOf(stamp, m_frame);
  const auto shown = m_shown;
  for (const int block : m_changed) addMarkers(block, header);
  if (m_markers.empty()) return m_changed.clear();
  ros2::MarkerArray message{};
  ros2::refer(message.markers, m_markers);
  if (m_writesMarkers.write(message))
    m_changed.clear();
  else
    m_shown = shown;  // it is tried again
}

void MapMessages::addMarkers(int block, const ros2::Header& header) {
  const auto voxels = occupiedVoxels(m_map, cornerOf(block, false), cornerOf(block, true));
  Shown now{hashOf(voxels), {}};
  if (m_shown[block].hash == now.hash) return;
  for (const PackedPoint& p : voxels) {
    const auto id = static_cast<ClassId>(p.label);
    m_cubes[{block, id}].push_back({double(p.x), double(p.y), double(p.z)});
    now.classes.insert(id);
  }
  std::set<ClassId> before = std::exchange(m_shown[block], now).classes;
  before.insert(now.classes.begin(), now.classes.end());
  for (const ClassId id : before) {
    const auto color = semantic_types::colorOf(id, m_map.classes());
    const double edge = m_map.getResolution();
    ros2::Marker marker{};
    marker.header = header;
    marker.ns = ros2::textOf(m_map.classes().name(id));
    marker.id = block;
    marker.type = kCubeList;
    marker.pose.orientation.w = 1;
    marker.scale = {edge, edge, edge};
    marker.color = {float(color.r) / 255, float(color.g) / 255, float(color.b) / 255, 1};
    const bool isThere = now.classes.count(id) > 0;
    marker.action = isThere ? kAdd : kDelete;
    if (isThere) ros2::refer(marker.points, m_cubes[{block, id}]);
    m_markers.push_back(marker);
  }
}

void MapMessages::publishPoints(Stamp stamp) {
  std::vector<PackedPoint> points = occupiedVoxels(m_map);
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
      m_writesChanges(node, "~/change", {true, false, kMostChanges}),
      m_writesAll(node, "~/compressed", {true, false, 1}) {}

void TreeMessages::publish(ros2::Stamp stamp) {
  if (!isRead()) return m_broadcast.reset();
  // No two runs have the same number.
  const auto run = std::chrono::system_clock::now().time_since_epoch().count();
  if (!m_broadcast) m_broadcast.emplace(m_map, static_cast<std::uint32_t>(run));
  const ros2::Header header = ros2::headerOf(stamp, m_frame);
  if (std::string change = m_broadcast->change(); !change.empty())
    write(m_writesChanges, header, kTree, m_map, std::move(change));
  if (isAsked()) write(m_writesAll, header, kTree, m_map, m_broadcast->all());
}

TreeReader::TreeReader(ros2::Node& node, const std::string& of)
    : m_node(node),
      m_allName(of + "/compressed"),
      m_hearsChanges(node, of + "/change", {true, false, kMostChanges},
                     [this](const Message& message) { take(message, false); }) {}

void TreeReader::take(const Message& message, bool isAll) {
  const std::lock_guard<std::mutex> lock(m_mutex);
  m_isAnswered |= isAll;
  try {
    if (ros2::textOf(message->id) != kTree)
      throw std::runtime_error("a message of '" + ros2::textOf(message->id) + "', expected " +
                               kTree);
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
