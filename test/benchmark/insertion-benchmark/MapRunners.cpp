#include <labeled_cloud/Trajectory.h>
#include <mrpt/maps/COctoMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/SemanticOcTree.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
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

/** OctoMap as its users call it; the points are in the world's frame already.
 * \param color also averages one into each voxel that is hit */
template <typename Tree, bool discretize, bool color = false>
Runner octomapRunner(const Scene& scene, const Settings& settings) {
  const auto tree = std::make_shared<Tree>(settings.resolution);
  std::vector<octomap::Pointcloud> clouds;
  for (const PosedScan& scan : scene.scans) clouds.push_back(worldPoints(scan));
  const double maxRange = settings.maxRange > 0 ? settings.maxRange : -1;
  return {[=, &scene, clouds = std::move(clouds)](std::size_t scan) {
    const octomap::point3d sensor = sensorOf(scene.scans[scan]);
    tree->insertPointCloud(clouds[scan], sensor, maxRange, false, discretize);
    if constexpr (color)
      for (std::size_t i = 0; i < clouds[scan].size(); ++i) {
        const octomap::point3d& p = clouds[scan][i];
        if (maxRange > 0 && (p - sensor).norm() > maxRange) continue;
        const std::uint8_t id = scene.scans[scan].cloud.classes[i];
        tree->averageNodeColor(p.x(), p.y(), p.z(), id, static_cast<std::uint8_t>(10 * id), 255);
      }
  }};
}

Runner mrptRunner(const Scene& scene, const Settings& settings) {
  const auto map = std::make_shared<mrpt::maps::COctoMap>(settings.resolution);
  map->insertionOptions.maxrange = settings.maxRange > 0 ? settings.maxRange : -1;
  std::vector<std::pair<mrpt::obs::CObservationPointCloud, mrpt::poses::CPose3D>> scans;
  for (const PosedScan& scan : scene.scans) {
    const auto points = mrpt::maps::CSimplePointsMap::Create();
    for (const Eigen::Vector3f& p : scan.cloud.points) points->insertPoint(p.x(), p.y(), p.z());
    auto& [observation, pose] = scans.emplace_back();
    observation.pointcloud = points;
    pose = labeled_cloud::toMrpt(scan.T_map_sensor);
  }
  return {[map, scans = std::move(scans)](std::size_t scan) {
    map->insertObservation(scans[scan].first, scans[scan].second);
  }};
}

/** Every other class is relevant, the others between are not. */
semantic_octree::AbstractionOptions abstractionOf(int terms, int numClasses) {
  semantic_octree::AbstractionOptions options;
  for (int i = 0; i < std::min(terms, numClasses); ++i) {
    const std::string name = "class " + std::to_string(i + 1);
    options.weights.terms.push_back(i % 2 == 0 ? tree_abstraction::relevant(name, 1.0, {i + 1})
                                               : tree_abstraction::irrelevant(name, 0.3, {i + 1}));
  }
  return options;
}

template <bool withAbstraction>
Runner ourRunner(const Scene& scene, const Settings& settings) {
  semantic_types::ClassTable classes;
  for (int id = 1; id <= scene.numClasses; ++id) classes.add("class " + std::to_string(id), {});
  const auto map = std::make_shared<semantic_octree::SemanticOcTree>(settings.resolution, classes);
  if (withAbstraction) setAbstraction(*map, abstractionOf(settings.terms, scene.numClasses));
  semantic_octree::InsertionOptions options;
  options.maxRange = settings.maxRange;
  options.rays = settings.rays;
  options.threads = settings.threads;
  return {[map, options, &scene](std::size_t scan) {
    map->insert(scene.scans[scan].cloud, scene.scans[scan].T_map_sensor, options);
  }};
}

/** The bare work of following all beams: an incremental traversal (Amanatides and Woo). It counts
 * in one byte per voxel of a dense array, in single precision, and knows the beams' ends. */
class DenseTraversal {
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

  void insert(std::size_t scan) {
    const Beams& beams = m_beams[scan];
    for (const End& end : beams.ends) {
      const std::ptrdiff_t last = traverse(beams.origin, end.position);
      if (end.isReturn) m_counts[last] |= 0x80;
    }
  }

  std::size_t touchedVoxels() const {
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

Runner traversalRunner(const Scene& scene, const Settings& settings) {
  const auto traversal = std::make_shared<DenseTraversal>(scene, settings);
  return {[traversal](std::size_t scan) { traversal->insert(scan); },
          [traversal] { return traversal->touchedVoxels(); }};
}

}  // namespace

const std::vector<std::pair<std::string, MakeRunner>>& runners() {
  static const std::vector<std::pair<std::string, MakeRunner>> runners = {
      {kTraversal, traversalRunner},
      {"semantic_octree", ourRunner<false>},
      {"semantic_octree with G", ourRunner<true>},
      {"octomap::OcTree", octomapRunner<octomap::OcTree, false>},
      {"octomap::OcTree, discretized", octomapRunner<octomap::OcTree, true>},
      {"octomap::ColorOcTree", octomapRunner<octomap::ColorOcTree, false, true>},
      {"mrpt::maps::COctoMap", mrptRunner}};
  return runners;
}

}  // namespace insertion_benchmark
