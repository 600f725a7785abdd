#include <view_information/GainField.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace view_information {

using Offset = std::array<int, 3>;

namespace {

constexpr int kMostVoxels = 1000;  // of a range
/** Beams of a template, above each other, if the shape names none, and at most all around. */
constexpr double kApart = 2;  // degrees
constexpr int kColumns = 2 * ViewTemplate::kHeadings;

using Beam = std::vector<Offset>;

int shellOf(const Offset& v) { return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])}); }

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

/** Straight, one voxel in each shell. */
struct Ray {
  std::array<double, 3> direction;
  double largest;  ///< part of it along an axis
  int shells;

  /** \param far voxels; up, around: radians */
  Ray(double far, double up, double around)
      : direction{std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up)},
        largest(std::max({std::abs(direction[0]), std::abs(direction[1]), std::abs(direction[2])})),
        shells(static_cast<int>(far * largest)) {}
  Offset at(int shell) const {
    Offset voxel;
    for (std::size_t a = 0; a < 3; ++a)
      voxel[a] = static_cast<int>(std::lround(shell * direction[a] / largest));
    return voxel;
  }
};

/** \param columns all around */
std::vector<Ray> raysOf(const ViewShape& shape, double far, int columns) {
  const double height = shape.highest - shape.lowest;
  const int rings =
      shape.rings > 0 ? shape.rings : 1 + static_cast<int>(std::ceil(height / kApart));
  std::vector<Ray> rays;
  for (int ring = 0; ring < rings; ++ring)
    for (int column = 0; column < columns; ++column) {
      const double share = rings > 1 ? static_cast<double>(ring) / (rings - 1) : 0;
      rays.emplace_back(far, (shape.lowest + share * height) * M_PI / 180,
                        2 * M_PI * (column + 0.5) / columns);
    }
  return rays;
}

/** Sorted: beams that share their first voxels are beside each other. */
std::vector<Beam> beamsOf(const std::vector<Ray>& rays) {
  std::vector<Beam> beams;
  for (const Ray& ray : rays) {
    beams.emplace_back();
    for (int shell = 1; shell <= ray.shells; ++shell) beams.back().push_back(ray.at(shell));
  }
  std::sort(beams.begin(), beams.end());
  return beams;
}

/** By shell, how many voxels lie between the elevations. */
std::vector<int> countsOf(const ViewShape& shape, int reach, double far) {
  std::vector<int> counts(static_cast<std::size_t>(reach) + 1, 0);
  for (int x = -reach; x <= reach; ++x)
    for (int y = -reach; y <= reach; ++y)
      for (int z = -reach; z <= reach; ++z) {
        const double flat = std::hypot(x, y);
        if (flat * flat + z * z > far * far) continue;
        const double up = std::atan2(z, flat) * 180 / M_PI;
        if (up >= shape.lowest && up <= shape.highest)
          ++counts[static_cast<std::size_t>(shellOf({x, y, z}))];
      }
  return counts;
}

ViewTemplate::Voxel voxelOf(const Offset& v) {
  return {static_cast<std::int16_t>(v[0]),         static_cast<std::int16_t>(v[1]),
          static_cast<std::int16_t>(v[2]),         static_cast<std::uint16_t>(shellOf(v)),
          static_cast<std::uint16_t>(sectorOf(v)), 0};
}

/** By shell, how many different voxels the rays have: a LiDAR has many, and few fit in memory. */
std::vector<int> countsOf(const std::vector<Ray>& rays, int reach) {
  std::vector<int> counts(static_cast<std::size_t>(reach) + 1, 0);
  std::vector<Offset> voxels;
  for (int shell = 1; shell <= reach; ++shell) {
    voxels.clear();
    for (const Ray& ray : rays)
      if (shell <= ray.shells) voxels.push_back(ray.at(shell));
    std::sort(voxels.begin(), voxels.end());
    const auto end = std::unique(voxels.begin(), voxels.end());
    counts[static_cast<std::size_t>(shell)] = static_cast<int>(end - voxels.begin());
  }
  return counts;
}

}  // namespace

/** A beam's voxels follow those that it shares with the one before. */
ViewTemplate::ViewTemplate(const ViewShape& shape, double voxelSize) : m_shape(shape) {
  requireWithin("range", shape.range, voxelSize, kMostVoxels * voxelSize);
  requireWithin("lowest", shape.lowest, -90, shape.highest);
  requireWithin("highest", shape.highest, shape.lowest, 90);
  requireWithin("width", shape.width, 1, 360);
  const double far = shape.range / voxelSize;
  m_reach = static_cast<int>(far);
  m_voxels.push_back(voxelOf({0, 0, 0}));
  std::vector<std::size_t> open{0};  // the last beam's voxels, behind the sensor's
  const auto close = [&](std::size_t shells) {
    for (; open.size() > shells; open.pop_back())
      m_voxels[open.back()].next = static_cast<std::int32_t>(m_voxels.size());
  };
  Beam last;
  const int columns = shape.rings > 0 ? std::min(shape.columns, kColumns) : kColumns;
  for (const Beam& beam : beamsOf(raysOf(shape, far, columns))) {
    const auto apart = std::mismatch(beam.begin(), beam.end(), last.begin(), last.end()).first;
    close(1 + static_cast<std::size_t>(apart - beam.begin()));
    for (auto v = apart; v != beam.end(); ++v) {
      open.push_back(m_voxels.size());
      m_voxels.push_back(voxelOf(*v));
      m_lowest = std::min(m_lowest, (*v)[2]), m_highest = std::max(m_highest, (*v)[2]);
    }
    last = beam;
  }
  close(0);
  // A beam stands for others, and where some that came apart share a voxel again, it counts once.
  const std::vector<int> all = shape.rings > 0
                                   ? countsOf(raysOf(shape, far, shape.columns), m_reach)
                                   : countsOf(shape, m_reach, far);
  std::vector<int> kept(all.size(), 0);
  for (const Voxel& v : m_voxels) ++kept[v.shell];
  for (std::size_t shell = 0; shell < all.size(); ++shell)
    m_weights.push_back(static_cast<float>(all[shell]) /
                        static_cast<float>(std::max(1, kept[shell])));
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
