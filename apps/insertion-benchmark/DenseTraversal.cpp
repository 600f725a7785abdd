#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "Runner.h"

namespace insertion_benchmark {
namespace {

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

}  // namespace

std::unique_ptr<Runner> denseTraversal(const Scene& scene, const Settings& settings) {
  return std::make_unique<DenseTraversal>(scene, settings);
}

}  // namespace insertion_benchmark
