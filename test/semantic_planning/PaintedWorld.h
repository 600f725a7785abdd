#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <cmath>
#include <map>
#include <tuple>

/** A world of labeled voxels, painted by hand, whose map is made by one scan from above. */
class PaintedWorld {
 public:
  enum Class : semantic_types::ClassId { Road = 1, Grass, Wall, Mud };

  explicit PaintedWorld(double voxelSize = 0.2)
      : m_voxelSize(voxelSize), m_map(voxelSize, classTable()) {}

  static semantic_types::ClassTable classTable() {
    semantic_types::ClassTable table;
    table.add("road", {90, 90, 100});
    table.add("grass", {100, 200, 80});
    table.add("wall", {200, 100, 60});
    table.add("mud", {120, 80, 40});
    return table;
  }

  /** Fills the voxels whose centers lie in a box; meters. A voxel keeps its last class. */
  PaintedWorld& box(double x0, double x1, double y0, double y1, double z0, double z1, Class id) {
    for (int x = first(x0); center(x) < x1; ++x)
      for (int y = first(y0); center(y) < y1; ++y)
        for (int z = first(z0); center(z) < z1; ++z) voxel(x, y, z, id);
    return *this;
  }
  /** One layer of voxels, its top at height 0. */
  PaintedWorld& floor(double x0, double x1, double y0, double y1, Class id) {
    return box(x0, x1, y0, y1, -m_voxelSize, 0, id);
  }
  /** Voxel by its number along each axis, counted from the origin. */
  PaintedWorld& voxel(int x, int y, int z, Class id) {
    m_painted[{x, y, z}] = id;
    return *this;
  }

  /** Inserts what was painted since the last call. \param sensor where the scan is taken from;
   * beams that come from below the ground would carve it. */
  semantic_octree::SemanticOcTree& map(const Eigen::Vector3d& sensor = {0.05, 0.05, 30}) {
    if (m_painted.empty()) return m_map;
    semantic_types::LabeledCloud cloud;
    for (const auto& [voxel, id] : m_painted) {
      const auto [x, y, z] = voxel;
      cloud.points.push_back(Eigen::Vector3f(center(x), center(y), center(z)) -
                             sensor.cast<float>());
      cloud.classes.push_back(id);
    }
    Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
    T_map_sensor.translation() = sensor;
    m_map.insert(cloud, T_map_sensor);
    m_painted.clear();
    return m_map;
  }

 private:
  int first(double x) const { return static_cast<int>(std::ceil(x / m_voxelSize - 0.5 - 1e-6)); }
  float center(int i) const { return static_cast<float>((i + 0.5) * m_voxelSize - 1e-9); }

  double m_voxelSize;
  semantic_octree::SemanticOcTree m_map;
  std::map<std::tuple<int, int, int>, Class> m_painted;
};
