#include <mrpt/maps/COctoMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/SemanticOcTree.h>

#include "Runner.h"

namespace insertion_benchmark {
namespace {

octomap::Pointcloud worldPoints(const PosedScan& scan) {
  octomap::Pointcloud cloud;
  cloud.reserve(scan.cloud.size());
  for (const Eigen::Vector3f& p : scan.cloud.points) {
    const Eigen::Vector3f q = (scan.T_map_sensor * p.cast<double>()).cast<float>();
    cloud.push_back(q.x(), q.y(), q.z());
  }
  return cloud;
}

octomap::point3d sensorOf(const PosedScan& scan) {
  const Eigen::Vector3f t = scan.T_map_sensor.translation().cast<float>();
  return {t.x(), t.y(), t.z()};
}

/** OctoMap as its users call it; the points are in the world's frame already. */
template <typename Tree>
class OctomapRunner : public Runner {
 public:
  OctomapRunner(const Scene& scene, const Settings& settings, bool discretize)
      : m_scene(scene),
        m_maxRange(settings.maxRange > 0 ? settings.maxRange : -1),
        m_discretize(discretize),
        m_tree(settings.resolution) {
    for (const PosedScan& scan : scene.scans) m_clouds.push_back(worldPoints(scan));
  }
  void insert(std::size_t scan) override {
    m_tree.insertPointCloud(m_clouds[scan], sensorOf(m_scene.scans[scan]), m_maxRange, false,
                            m_discretize);
  }

 protected:
  const Scene& m_scene;
  double m_maxRange;
  bool m_discretize;
  Tree m_tree;
  std::vector<octomap::Pointcloud> m_clouds;
};

/** Also averages a color into each voxel that is hit. */
class ColorRunner : public OctomapRunner<octomap::ColorOcTree> {
 public:
  using OctomapRunner::OctomapRunner;
  void insert(std::size_t scan) override {
    OctomapRunner::insert(scan);
    const octomap::point3d sensor = sensorOf(m_scene.scans[scan]);
    for (std::size_t i = 0; i < m_clouds[scan].size(); ++i) {
      const octomap::point3d& p = m_clouds[scan][i];
      if (m_maxRange > 0 && (p - sensor).norm() > m_maxRange) continue;
      const std::uint8_t id = m_scene.scans[scan].cloud.classes[i];
      m_tree.averageNodeColor(p.x(), p.y(), p.z(), id, static_cast<std::uint8_t>(10 * id), 255);
    }
  }
};

class MrptRunner : public Runner {
 public:
  MrptRunner(const Scene& scene, const Settings& settings) : m_map(settings.resolution) {
    m_map.insertionOptions.maxrange = settings.maxRange > 0 ? settings.maxRange : -1;
    for (const PosedScan& scan : scene.scans) {
      const auto points = mrpt::maps::CSimplePointsMap::Create();
      for (const Eigen::Vector3f& p : scan.cloud.points) points->insertPoint(p.x(), p.y(), p.z());
      mrpt::obs::CObservationPointCloud& observation = m_observations.emplace_back();
      observation.pointcloud = points;
      const Eigen::Matrix4d m = scan.T_map_sensor.matrix();
      m_poses.emplace_back(mrpt::math::CMatrixDouble44(m));
    }
  }
  void insert(std::size_t scan) override {
    m_map.insertObservation(m_observations[scan], m_poses[scan]);
  }

 private:
  mrpt::maps::COctoMap m_map;
  std::vector<mrpt::obs::CObservationPointCloud> m_observations;
  std::vector<mrpt::poses::CPose3D> m_poses;
};

}  // namespace

std::unique_ptr<Runner> octomapOcTree(const Scene& scene, const Settings& settings) {
  return std::make_unique<OctomapRunner<octomap::OcTree>>(scene, settings, false);
}

std::unique_ptr<Runner> octomapDiscretized(const Scene& scene, const Settings& settings) {
  return std::make_unique<OctomapRunner<octomap::OcTree>>(scene, settings, true);
}

std::unique_ptr<Runner> octomapColorOcTree(const Scene& scene, const Settings& settings) {
  return std::make_unique<ColorRunner>(scene, settings, false);
}

std::unique_ptr<Runner> mrptOctoMap(const Scene& scene, const Settings& settings) {
  return std::make_unique<MrptRunner>(scene, settings);
}

namespace {

using semantic_octree::SemanticOcTree;

class OurRunner : public Runner {
 public:
  OurRunner(const Scene& scene, const Settings& settings, bool withAbstraction)
      : m_scene(scene), m_map(settings.resolution, classes(scene.numClasses)) {
    m_options.maxRange = settings.maxRange;
    m_options.rays = settings.rays;
    m_options.threads = settings.threads;
    if (withAbstraction) setAbstraction(m_map, abstraction(settings.terms, scene.numClasses));
  }
  void insert(std::size_t scan) override {
    m_map.insert(m_scene.scans[scan].cloud, m_scene.scans[scan].T_map_sensor, m_options);
  }

 private:
  static semantic_types::ClassTable classes(int numClasses) {
    semantic_types::ClassTable table;
    for (int id = 1; id <= numClasses; ++id) table.add("class " + std::to_string(id), {});
    return table;
  }
  /** Every other class is relevant, the others between are not. */
  static semantic_octree::AbstractionOptions abstraction(int terms, int numClasses) {
    semantic_octree::AbstractionOptions options;
    for (int i = 0; i < std::min(terms, numClasses); ++i) {
      const std::string name = "class " + std::to_string(i + 1);
      options.weights.terms.push_back(i % 2 == 0
                                          ? tree_abstraction::relevant(name, 1.0, {i + 1})
                                          : tree_abstraction::irrelevant(name, 0.3, {i + 1}));
    }
    return options;
  }

  const Scene& m_scene;
  SemanticOcTree m_map;
  semantic_octree::InsertionOptions m_options;
};

}  // namespace

std::unique_ptr<Runner> semanticOcTree(const Scene& scene, const Settings& settings) {
  return std::make_unique<OurRunner>(scene, settings, false);
}

std::unique_ptr<Runner> semanticOcTreeWithAbstraction(const Scene& scene,
                                                      const Settings& settings) {
  return std::make_unique<OurRunner>(scene, settings, true);
}

}  // namespace insertion_benchmark
