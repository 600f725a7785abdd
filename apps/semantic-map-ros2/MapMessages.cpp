#include "MapMessages.h"

#include <map_operations/OctomapConversion.h>
#include <octomap/OcTree.h>
#include <semantic_types/ClassColors.h>

#include <algorithm>
#include <sstream>
#include <utility>

namespace semantic_map_ros2 {

using octomap::OcTreeKey;
using ros2::Stamp;
using semantic_octree::SemanticOcTree;

namespace {

constexpr int kTile = 8, kBlock = 64;  // voxels
constexpr std::int32_t kCubeList = 6, kAdd = 0, kDelete = 2;
constexpr int kUint32 = 6, kFloat32 = 7;

std::uint64_t numberOf(int x, int y, int z) {
  return std::uint64_t(x) << 32 | std::uint64_t(y) << 16 | std::uint64_t(z);
}
std::uint64_t blockOf(const OcTreeKey& key) {
  return numberOf(key[0] / kBlock, key[1] / kBlock, key[2] / kBlock);
}
/** A block has ten bits an axis. */
std::int32_t idOf(std::uint64_t block) {
  return static_cast<std::int32_t>((block >> 32 & 1023) << 20 | (block >> 16 & 1023) << 10 |
                                   (block & 1023));
}

/** A point of `~/occupied`. */
struct PackedPoint {
  float x, y, z;
  std::uint32_t rgb, label;
  float probability;
};
static_assert(sizeof(PackedPoint) == 24, "as the fields say");

}  // namespace

MapMessages::MapMessages(ros2::Node& node, SemanticOcTree& map, std::string frame)
    : m_map(map),
      m_frame(std::move(frame)),
      m_follower(map.follow()),
      m_writesMarkers(node, "~/markers", {true, false, 100}),
      m_writesPoints(node, "~/occupied", {true, true, 1}),
      m_writesOctomap(node, "~/octomap", {true, true, 1}) {}

void MapMessages::publish(Stamp stamp) {
  follow();
  publishMarkers(stamp);
  if (m_writesPoints.isRead()) publishPoints(stamp);
  if (m_writesOctomap.isRead()) publishOctomap(stamp);
}

void MapMessages::follow() {
  const semantic_octree::TileChange change = m_follower.tiles();
  if (change.all) {
    for (const auto& [block, tiles] : m_blocks) m_changed.insert(block);
    m_tiles.clear();
    m_blocks.clear();
  }
  for (const OcTreeKey& tile : change.tiles) read(tile);
}

void MapMessages::read(const OcTreeKey& tile) {
  const auto last = [&](int axis) { return octomap::key_type(tile[axis] + kTile - 1); };
  const OcTreeKey high(last(0), last(1), last(2));
  std::vector<Voxel> voxels;
  for (auto it = m_map.begin_leafs_bbx(tile, high); it != m_map.end_leafs_bbx(); ++it) {
    if (!m_map.isNodeOccupied(*it)) continue;
    const auto state = m_map.query(*it);
    const bool hasClass = state.likeliestClass != semantic_types::kNoClass;
    const auto probability = static_cast<float>(hasClass ? state.probability : state.occupancy);
    // Leaves may be larger than voxels, and than the tile.
    const OcTreeKey low = it.getIndexKey();
    const int edge = semantic_octree::edgeAtDepth(static_cast<int>(it.getDepth()));
    const auto from = [&](int a) { return std::max<int>(low[a], tile[a]); };
    const auto to = [&](int a) { return std::min<int>(low[a] + edge - 1, high[a]); };
    for (int x = from(0); x <= to(0); ++x)
      for (int y = from(1); y <= to(1); ++y)
        for (int z = from(2); z <= to(2); ++z)
          voxels.push_back({std::uint16_t(x), std::uint16_t(y), std::uint16_t(z),
                            state.likeliestClass, probability});
  }
  const std::uint64_t number = numberOf(tile[0], tile[1], tile[2]), block = blockOf(tile);
  std::vector<Voxel>& known = m_tiles[number];
  const auto same = [](const Voxel& a, const Voxel& b) { return a.looksLike(b); };
  if (!std::equal(known.begin(), known.end(), voxels.begin(), voxels.end(), same))
    m_changed.insert(block);
  known = std::move(voxels);
  if (!known.empty()) {
    m_blocks[block].insert(number);
    return;
  }
  m_tiles.erase(number);
  if (const auto it = m_blocks.find(block); it != m_blocks.end())
    if (it->second.erase(number), it->second.empty()) m_blocks.erase(it);
}

ros2::Point MapMessages::centerOf(const Voxel& v) const {
  const auto center = [this](int key) {
    return semantic_octree::centerOf(key, m_map.getResolution());
  };
  return {center(v.x), center(v.y), center(v.z)};
}

void MapMessages::publishMarkers(Stamp stamp) {
  if (m_writesMarkers.hasNewReader()) {
    m_shown.clear();  // it shows nothing yet
    for (const auto& [block, tiles] : m_blocks) m_changed.insert(block);
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
  if (const auto tiles = m_blocks.find(block); tiles != m_blocks.end())
    for (const std::uint64_t tile : tiles->second)
      for (const Voxel& voxel : m_tiles.at(tile)) {
        m_cubes[{block, voxel.classId}].push_back(centerOf(voxel));
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
  std::vector<PackedPoint> points;
  for (const auto& [number, voxels] : m_tiles)
    for (const Voxel& voxel : voxels) {
      const auto center = centerOf(voxel);
      const auto c = semantic_types::colorOf(voxel.classId, m_map.classes());
      points.push_back({float(center.x), float(center.y), float(center.z),
                        std::uint32_t(c.r) << 16 | std::uint32_t(c.g) << 8 | c.b, voxel.classId,
                        voxel.probability});
    }
  const std::vector<std::string> names = {"x", "y", "z", "rgb", "label", "probability"};
  std::vector<ros2::PointField> fields;
  for (std::uint32_t i = 0; i < names.size(); ++i)
    fields.push_back(
        {ros2::textOf(names[i]), 4 * i, std::uint8_t(names[i] == "label" ? kUint32 : kFloat32), 1});
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
