#include <mrpt/maps/COctoMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/SemanticOcTree.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

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

/** The bare work of following all beams: an incremental traversal (Amanatides and Woo) that counts
 * in one byte per voxel of a dense array, in single precision and with the beams' ends known. */
class DenseTraversal : public Runner {
 public:
  DenseTraversal(const Scene& scene, const Settings& settings) {
    Eigen::Array3f lowest = Eigen::Array3f::Constant(1e9f), highest = -lowest;
    for (const PosedScan& scan : scene.scans) {
      addBeams(scan, settings);
      const auto include = [&](const Eigen::Array3f& u) {
        lowest = lowest.min(u), highest = highest.max(u);
      };
      include(m_beams.back().origin);
      for (const End& end : m_beams.back().ends) include(end.position);
    }
    const Eigen::Array3f first = lowest.floor() - 1;
    const Eigen::Array3i size = (highest.floor() - first).cast<int>() + 2;
    m_strides = {1, size.x(), std::ptrdiff_t(size.x()) * size.y()};
    const double cells = size.cast<double>().prod();
    if (cells > 4e9) throw std::runtime_error("the scene is too large for a dense array");
    m_counts.assign(static_cast<std::size_t>(cells),
                    1);  // not untouched pages: they would be timed
    std::fill(m_counts.begin(), m_counts.end(), 0);
    for (Beams& beams : m_beams) {
      beams.origin -= first;
      for (End& end : beams.ends) end.position -= first;
    }
  }

  void insert(std::size_t scan) override {
    const Beams& beams = m_beams[scan];
    for (const End& end : beams.ends) {
      const std::ptrdiff_t last = traverse(beams.origin, end.position);
      if (end.isReturn) m_counts[last] |= 0x80;
    }
  }

  std::size_t touchedVoxels() const override {
    return m_counts.size() - std::count(m_counts.begin(), m_counts.end(), 0);
  }

 private:
  struct End {
    Eigen::Array3f position;  ///< voxels
    bool isReturn;
  };
  struct Beams {
    Eigen::Array3f origin;
    std::vector<End> ends;
  };
  struct Axis {
    float next = HUGE_VALF, delta = 0;
    std::ptrdiff_t stride = 0;
    int steps = 0;
  };

  void addBeams(const PosedScan& scan, const Settings& settings) {
    Beams& beams = m_beams.emplace_back();
    const Eigen::Vector3d sensor = scan.T_map_sensor.translation();
    beams.origin = (sensor / settings.resolution).cast<float>();
    for (const Eigen::Vector3f& p : scan.cloud.points) {
      const Eigen::Vector3d beam = scan.T_map_sensor.linear() * p.cast<double>();
      const double range = beam.norm();
      if (!std::isfinite(range)) continue;
      const bool isReturn = settings.maxRange <= 0 || range <= settings.maxRange;
      const Eigen::Vector3d end = sensor + beam * (isReturn ? 1 : settings.maxRange / range);
      beams.ends.push_back({(end / settings.resolution).cast<float>(), isReturn});
    }
  }

  Axis axisOf(const Eigen::Array3f& begin, const Eigen::Array3f& end, int i) const {
    Axis axis;
    const int first = static_cast<int>(begin[i]), last = static_cast<int>(end[i]);
    if (first == last) return axis;
    axis.steps = std::abs(last - first);
    axis.stride = last > first ? m_strides[i] : -m_strides[i];
    axis.delta = 1.f / std::fabs(end[i] - begin[i]);
    axis.next = (last > first ? static_cast<float>(first + 1) - begin[i]
                              : begin[i] - static_cast<float>(first)) *
                axis.delta;
    return axis;
  }

  /** \return the position of the voxel in which the beam ends */
  std::ptrdiff_t traverse(const Eigen::Array3f& begin, const Eigen::Array3f& end) {
    Axis x = axisOf(begin, end, 0), y = axisOf(begin, end, 1), z = axisOf(begin, end, 2);
    std::ptrdiff_t position = 0;
    for (int i = 0; i < 3; ++i) position += m_strides[i] * static_cast<int>(begin[i]);
    std::uint8_t* const counts = m_counts.data();
    for (int n = x.steps + y.steps + z.steps; n > 0; --n) {
      counts[position] |= 1;
      if (x.next < y.next && x.next < z.next)
        position += x.stride, x.next += x.delta;
      else if (y.next < z.next)
        position += y.stride, y.next += y.delta;
      else
        position += z.stride, z.next += z.delta;
    }
    return position;
  }

  std::vector<Beams> m_beams;
  std::array<std::ptrdiff_t, 3> m_strides{};
  std::vector<std::uint8_t> m_counts;
};

template <class R, bool... more>
std::unique_ptr<Runner> make(const Scene& scene, const Settings& settings) {
  return std::make_unique<R>(scene, settings, more...);
}

}  // namespace

const std::vector<std::pair<std::string, MakeRunner>>& runners() {
  static const std::vector<std::pair<std::string, MakeRunner>> runners = {
      {kTraversal, make<DenseTraversal>},
      {"semantic_octree", make<OurRunner, false>},
      {kReference, make<OurRunner, true>},
      {"octomap::OcTree", make<OctomapRunner<octomap::OcTree>, false>},
      {"octomap::OcTree, discretized", make<OctomapRunner<octomap::OcTree>, true>},
      {"octomap::ColorOcTree", make<ColorRunner, false>},
      {"mrpt::maps::COctoMap", make<MrptRunner>}};
  return runners;
}

}  // namespace insertion_benchmark
