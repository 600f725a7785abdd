#include <view_information/GainField.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace view_information {

using Offset = std::array<int, 3>;

namespace {

/** Up to here a shape without beams has all its voxels. Beyond, it has one beam through each that
 * is there, for unknown space is predicted more coarsely than that. */
constexpr double kAll = 5;         // m
constexpr int kMostVoxels = 1000;  // of a range

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

std::uint64_t idOf(const Offset& v) {
  std::uint64_t id = 0;
  for (const int a : v) id = id << 20 | static_cast<std::uint64_t>(a + kMostVoxels);
  return id;
}

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

/** The voxels of the shape, those through which they are seen, and the sensor's; all are marked.
 * \param counts by shell: voxels of the shape */
std::vector<Offset> offsetsOf(const ViewShape& shape, int reach, double voxelSize,
                              std::unordered_map<std::uint64_t, int>& marked,
                              std::vector<int>& counts) {
  std::vector<Offset> all{{0, 0, 0}};
  marked[idOf(all.front())] = 0;
  const auto add = [&](const Offset& farthest) {
    for (Offset v = farthest; marked.emplace(idOf(v), 0).second; v = parentOf(v)) all.push_back(v);
  };
  const double far = std::min(shape.range / voxelSize, static_cast<double>(reach));
  const int last = static_cast<int>(kAll / voxelSize);
  if (shape.rings > 0)
    forBeams(shape, far, add);
  else
    forVoxels(shape, reach, shape.range / voxelSize, [&](const Offset& v) {
      const int shell = shellOf(v);
      ++counts[static_cast<std::size_t>(shell)];
      if (shell <= last) add(v);
      if (shell != last) return;
      const double factor = far / std::hypot(v[0], v[1], v[2]);
      Offset end;
      for (std::size_t a = 0; a < 3; ++a) end[a] = static_cast<int>(std::lround(factor * v[a]));
      if (factor > 1) add(end);
    });
  return all;
}

}  // namespace

ViewTemplate::ViewTemplate(const ViewShape& shape, double voxelSize) : m_shape(shape) {
  requireWithin("range", shape.range, voxelSize, kMostVoxels * voxelSize);
  requireWithin("lowest", shape.lowest, -90, shape.highest);
  requireWithin("highest", shape.highest, shape.lowest, 90);
  requireWithin("width", shape.width, 1, 360);
  m_reach = static_cast<int>(shape.range / voxelSize);
  std::unordered_map<std::uint64_t, int> numbers;
  std::vector<int> counts(static_cast<std::size_t>(m_reach) + 1, 0), kept = counts;
  std::vector<Offset> order = offsetsOf(shape, m_reach, voxelSize, numbers, counts);
  std::sort(order.begin(), order.end(), [](const Offset& a, const Offset& b) {
    return std::make_pair(shellOf(a), a) < std::make_pair(shellOf(b), b);
  });
  for (std::size_t i = 0; i < order.size(); ++i) numbers[idOf(order[i])] = static_cast<int>(i);
  std::vector<std::size_t> parents(order.size(), 0);
  std::vector<std::int32_t> sizes(order.size(), 1);  // with all behind it
  for (std::size_t i = order.size() - 1; i > 0; --i) {
    parents[i] = static_cast<std::size_t>(numbers[idOf(parentOf(order[i]))]);
    sizes[parents[i]] += sizes[i];
  }
  // A voxel, then one after the other with all that is seen through it.
  std::vector<std::int32_t> free(order.size(), 1);
  m_voxels.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::int32_t place =
        i > 0 ? std::exchange(free[parents[i]], free[parents[i]] + sizes[i]) : 0;
    free[i] = place + 1;
    const auto& [x, y, z] = order[i];
    ++kept[static_cast<std::size_t>(shellOf(order[i]))];
    m_voxels[static_cast<std::size_t>(place)] = {static_cast<std::int16_t>(x),
                                                 static_cast<std::int16_t>(y),
                                                 static_cast<std::int16_t>(z),
                                                 static_cast<std::uint16_t>(shellOf(order[i])),
                                                 static_cast<std::uint16_t>(sectorOf(order[i])),
                                                 place + sizes[i]};
    m_lowest = std::min(m_lowest, z), m_highest = std::max(m_highest, z);
  }
  for (std::size_t shell = 0; shell < kept.size(); ++shell)
    m_weights.push_back(counts[shell] > kept[shell]
                            ? static_cast<float>(counts[shell]) / static_cast<float>(kept[shell])
                            : 1);
}

namespace {
int sectorsOf(double width) {
  constexpr int kHeadings = ViewTemplate::kHeadings;
  return std::clamp(static_cast<int>(std::lround(width / 360 * kHeadings)), 1, kHeadings);
}
}  // namespace

bool ViewTemplate::sees(const Voxel& voxel, int sector) const {
  const int sectors = sectorsOf(m_shape.width);
  return (voxel.heading - sector + sectors / 2 + kHeadings) % kHeadings < sectors;
}

double headingOf(int sector) { return -M_PI + (sector + 0.5) * 2 * M_PI / ViewTemplate::kHeadings; }

double gainOfHeading(const SectorGains& gains, int sector, double width) {
  constexpr int kHeadings = ViewTemplate::kHeadings;
  const int sectors = sectorsOf(width);
  double sum = 0;
  for (int i = 0; i < sectors; ++i)
    sum += gains[static_cast<std::size_t>((sector - sectors / 2 + i + kHeadings) % kHeadings)];
  return sum;
}

}  // namespace view_information
