#include "NodeMap.h"

#include <semantic_types/ClassTable.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace semantic_map_ros2 {

using Eigen::Isometry3d;
using octomap::OcTreeKey;
using semantic_octree::SemanticOcTree;

namespace {

constexpr int kTile = 8, kBlock = 64;  // voxels

std::uint64_t numberOf(int x, int y, int z) {
  return std::uint64_t(x) << 32 | std::uint64_t(y) << 16 | std::uint64_t(z);
}

/** x, y and heading of a pose. */
Isometry3d upright(const Isometry3d& T) {
  return Eigen::Translation3d(T(0, 3), T(1, 3), 0) *
         Eigen::AngleAxisd(std::atan2(T(1, 0), T(0, 0)), Eigen::Vector3d::UnitZ());
}

/** No two runs have the same. */
std::uint32_t numberOfRun() {
  return static_cast<std::uint32_t>(std::chrono::system_clock::now().time_since_epoch().count());
}

}  // namespace

void relocalize(semantic_slam::Mapper& mapper, const Isometry3d& T_map_said,
                const Isometry3d& T_odometry_robot) {
  const Isometry3d T_before = mapper.T_map_odometry() * T_odometry_robot;
  const Isometry3d T_map_robot = upright(T_map_said) * upright(T_before).inverse() * T_before;
  mapper.relocalize(T_map_robot * T_odometry_robot.inverse());
}

const std::array<std::pair<std::string, std::uint8_t>, 6>& fieldsOfPoint() {
  constexpr std::uint8_t kUint32 = 6, kFloat32 = 7;
  static const std::array<std::pair<std::string, std::uint8_t>, 6> fields = {
      {{"x", kFloat32},
       {"y", kFloat32},
       {"z", kFloat32},
       {"rgb", kFloat32},
       {"label", kUint32},
       {"probability", kFloat32}}};
  return fields;
}

OccupiedVoxels::OccupiedVoxels(SemanticOcTree& map) : m_map(map), m_follower(map.follow()) {}

std::set<std::uint64_t> OccupiedVoxels::follow() {
  const semantic_octree::TileChange change = m_follower.tiles();
  std::set<std::uint64_t> changed;
  if (change.all)
    for (const auto& [number, block] : std::exchange(m_blocks, {})) changed.insert(number);
  for (const OcTreeKey& tile : change.tiles) {
    const std::uint64_t number = numberOf(tile[0] / kBlock, tile[1] / kBlock, tile[2] / kBlock);
    std::vector<Voxel> voxels = read(tile);
    if (voxels.empty() && m_blocks.count(number) == 0) continue;
    Block& block = m_blocks[number];
    const auto known = block.emplace(numberOf(tile[0], tile[1], tile[2]), 0).first;
    const auto same = [](const Voxel& a, const Voxel& b) { return a.looksLike(b); };
    if (!std::equal(known->second.begin(), known->second.end(), voxels.begin(), voxels.end(), same))
      changed.insert(number);
    known->second = std::move(voxels);
    if (known->second.empty()) block.erase(known);
    if (block.empty()) m_blocks.erase(number);
  }
  return changed;
}

auto OccupiedVoxels::read(const OcTreeKey& tile) const -> std::vector<Voxel> {
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
  return voxels;
}

std::array<double, 3> OccupiedVoxels::centerOf(const Voxel& v) const {
  const auto center = [this](int key) {
    return semantic_octree::centerOf(key, m_map.getResolution());
  };
  return {center(v.x), center(v.y), center(v.z)};
}

std::vector<PackedPoint> OccupiedVoxels::points() const {
  std::vector<PackedPoint> points;
  for (const auto& [number, block] : m_blocks)
    for (const auto& [tile, voxels] : block)
      for (const Voxel& voxel : voxels) {
        const auto [x, y, z] = centerOf(voxel);
        const auto c = semantic_types::colorOf(voxel.classId, m_map.classes());
        points.push_back({float(x), float(y), float(z),
                          std::uint32_t(c.r) << 16 | std::uint32_t(c.g) << 8 | c.b, voxel.classId,
                          voxel.probability});
      }
  return points;
}

const std::string TreeTeller::kId = "SemanticTree";

void TreeTeller::tell(bool isRead, const Write& change, const Write& all) {
  if (!isRead) return m_broadcast.reset();
  if (!m_broadcast) m_broadcast.emplace(m_map, numberOfRun());
  if (std::string data = m_broadcast->change(); !data.empty()) change(std::move(data));
  if (all) all(m_broadcast->all());
}

}  // namespace semantic_map_ros2
