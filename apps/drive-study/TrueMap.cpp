#include "TrueMap.h"

#include <synthetic_world/Solids.h>

#include <cmath>

namespace drive_study {

using semantic_types::LabeledCloud;
using synthetic_world::PointTruth;
using synthetic_world::World;

namespace {

/** The centers of the voxels that something fills, column by column. */
class TrueVoxels {
 public:
  TrueVoxels(const World& world, double voxelSize, double height)
      : m_world(world),
        m_voxelSize(voxelSize),
        m_layers(static_cast<int>(std::ceil(height / voxelSize)) + 1) {}

  LabeledCloud all() {
    const int half = static_cast<int>(m_world.halfExtent() / m_voxelSize);
    for (int y = -half; y < half; ++y)
      for (int x = -half; x < half; ++x) addColumn(center(x), center(y));
    return std::move(m_cloud);
  }

 private:
  double center(int i) const { return (i + 0.5) * m_voxelSize; }

  void add(double x, double y, double z, semantic_types::ClassId id) {
    m_cloud.points.push_back(Eigen::Vector3d(x, y, z).cast<float>());
    m_cloud.classes.push_back(id);
  }

  void addColumn(double x, double y) {
    const int ground = static_cast<int>(std::floor(m_world.groundHeight(x, y) / m_voxelSize));
    add(x, y, center(ground), m_world.groundClass(x, y));
    for (int z = ground + 1; z <= ground + m_layers; ++z) {
      const PointTruth truth = m_world.at({x, y, center(z)}, m_voxelSize / 2);
      if (isThing(truth)) add(x, y, center(z), truth.id);
    }
  }

  /** The ground is in its own voxel, and not in the one above that it nearly reaches. */
  static bool isThing(const PointTruth& truth) {
    return truth.state != PointTruth::State::Free &&
           (truth.state != PointTruth::State::Surface || truth.id > synthetic_world::kWater);
  }

  const World& m_world;
  double m_voxelSize;
  int m_layers;
  LabeledCloud m_cloud;
};

}  // namespace

semantic_octree::SemanticOcTree trueMap(const World& world, double voxelSize, double height) {
  LabeledCloud cloud = TrueVoxels(world, voxelSize, height).all();
  semantic_octree::SemanticOcTree map(voxelSize, synthetic_world::classTable());
  semantic_octree::InsertionOptions options;
  options.carvingMargin = 1e6;  // nothing is carved: what is not filled stays unknown
  map.insert(cloud, Eigen::Isometry3d::Identity(), options);
  return map;
}

}  // namespace drive_study
