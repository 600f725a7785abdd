#include <view_information/GainField.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace view_information {

namespace {

using Offset = std::array<int, 3>;

int shellOf(const Offset& v) { return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])}); }

/** The voxel before on the line to the sensor. */
Offset parentOf(const Offset& v) {
  const int shell = shellOf(v);
  const double share = static_cast<double>(shell - 1) / shell;
  Offset parent;
  for (std::size_t a = 0; a < 3; ++a) parent[a] = static_cast<int>(std::lround(v[a] * share));
  return parent;
}

int sectorOf(const Offset& v) {
  const double turned = (std::atan2(v[1], v[0]) + M_PI) / (2 * M_PI) * ViewTemplate::kHeadings;
  return std::min(ViewTemplate::kHeadings - 1, static_cast<int>(turned));
}

void requireWithin(const char* what, double value, double least, double most) {
  if (value >= least && value <= most) return;
  throw std::invalid_argument(std::string("ViewShape: ") + what + " = " + std::to_string(value) +
                              ", expected " + std::to_string(least) + " to " +
                              std::to_string(most));
}

/** A number for each offset up to a reach. */
class OffsetTable {
 public:
  explicit OffsetTable(int reach)
      : m_reach(reach),
        m_edge(2 * reach + 1),
        m_numbers(static_cast<std::size_t>(m_edge) * m_edge * m_edge, -1) {}
  int& at(const Offset& v) {
    return m_numbers[static_cast<std::size_t>(
        ((v[0] + m_reach) * m_edge + v[1] + m_reach) * m_edge + v[2] + m_reach)];
  }

 private:
  int m_reach;
  std::ptrdiff_t m_edge;
  std::vector<int> m_numbers;
};

/** f(offset) for the farthest voxel of each beam. */
template <class F>
void forBeams(const ViewShape& shape, double far, F f) {
  for (int ring = 0; ring < shape.rings; ++ring)
    for (int column = 0; column < shape.columns; ++column) {
      const double share = shape.rings > 1 ? static_cast<double>(ring) / (shape.rings - 1) : 0;
      const double up = (shape.lowest + share * (shape.highest - shape.lowest)) * M_PI / 180;
      const double around = 2 * M_PI * column / shape.columns;
      f(Offset{static_cast<int>(std::lround(far * std::cos(up) * std::cos(around))),
               static_cast<int>(std::lround(far * std::cos(up) * std::sin(around))),
               static_cast<int>(std::lround(far * std::sin(up)))});
    }
}

/** f(offset) for all voxels between the elevations. */
template <class F>
void forVoxels(const ViewShape& shape, int reach, double far, F f) {
  for (int x = -reach; x <= reach; ++x)
    for (int y = -reach; y <= reach; ++y)
      for (int z = -reach; z <= reach; ++z) {
        const double flat = std::hypot(x, y);
        if (flat * flat + z * z > far * far) continue;
        const double up = std::atan2(z, flat) * 180 / M_PI;
        if (up >= shape.lowest && up <= shape.highest) f(Offset{x, y, z});
      }
}

/** Those of the shape and all through which they are seen; the sensor's too. Marked in the table.
 */
std::vector<Offset> offsetsOf(const ViewShape& shape, int reach, double voxelSize,
                              OffsetTable& marked) {
  std::vector<Offset> all{{0, 0, 0}};
  marked.at(all.front()) = 0;
  const auto add = [&](const Offset& farthest) {
    for (Offset v = farthest; marked.at(v) < 0; v = parentOf(v)) marked.at(v) = 0, all.push_back(v);
  };
  const double far = shape.range / voxelSize;
  if (shape.rings > 0)
    forBeams(shape, std::min<double>(far, reach), add);
  else
    forVoxels(shape, reach, far, add);
  return all;
}

}  // namespace

ViewTemplate::ViewTemplate(const ViewShape& shape, double voxelSize) : m_shape(shape) {
  requireWithin("range", shape.range, voxelSize, 1000 * voxelSize);
  requireWithin("lowest", shape.lowest, -90, shape.highest);
  requireWithin("highest", shape.highest, shape.lowest, 90);
  requireWithin("width", shape.width, 1, 360);
  m_reach = static_cast<int>(shape.range / voxelSize);
  OffsetTable numbers(m_reach);
  std::vector<Offset> order = offsetsOf(shape, m_reach, voxelSize, numbers);
  std::sort(order.begin(), order.end(), [](const Offset& a, const Offset& b) {
    return std::make_pair(shellOf(a), a) < std::make_pair(shellOf(b), b);
  });
  for (std::size_t i = 0; i < order.size(); ++i) numbers.at(order[i]) = static_cast<int>(i);
  std::vector<std::int32_t> parents(order.size(), 0), sizes(order.size(), 1);  // with all behind it
  for (std::size_t i = order.size() - 1; i > 0; --i) {
    parents[i] = numbers.at(parentOf(order[i]));
    sizes[static_cast<std::size_t>(parents[i])] += sizes[i];
  }
  // A voxel, then one after the other with all that is seen through it.
  std::vector<std::int32_t> places(order.size(), 0), free(order.size(), 1);
  m_voxels.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto parent = static_cast<std::size_t>(parents[i]);
    if (i > 0) places[i] = std::exchange(free[parent], free[parent] + sizes[i]);
    free[i] = places[i] + 1;
    const auto& [x, y, z] = order[i];
    m_voxels[static_cast<std::size_t>(places[i])] = {static_cast<std::int16_t>(x),
                                                     static_cast<std::int16_t>(y),
                                                     static_cast<std::int16_t>(z),
                                                     static_cast<std::uint8_t>(sectorOf(order[i])),
                                                     places[parent],
                                                     places[i] + sizes[i]};
    m_lowest = std::min(m_lowest, z), m_highest = std::max(m_highest, z);
  }
}

double headingOf(int sector) { return -M_PI + (sector + 0.5) * 2 * M_PI / ViewTemplate::kHeadings; }

double gainOfHeading(const SectorGains& gains, int sector, double width) {
  constexpr int kHeadings = ViewTemplate::kHeadings;
  const int sectors =
      std::clamp(static_cast<int>(std::lround(width / 360 * kHeadings)), 1, kHeadings);
  double sum = 0;
  for (int i = 0; i < sectors; ++i)
    sum += gains[static_cast<std::size_t>((sector - sectors / 2 + i + kHeadings) % kHeadings)];
  return sum;
}

}  // namespace view_information
