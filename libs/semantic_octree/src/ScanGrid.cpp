#include <semantic_octree/store/ScanGrid.h>

#include <semantic_octree/store/Lanes.h>
#include <strict_files/TextFile.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <limits>
#include <new>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>

#include "Parallel.h"

namespace semantic_octree {
namespace {

constexpr int kTileSide = 8, kBitsPerTile = 512, kTilesPerPage = 64;
/** More pages than fit along the slowest axis, in bits that never overflow. */
constexpr std::size_t kAllPages = (std::size_t(1) << 12) - 1;

/** Bits 0, 1, 2 of a coordinate moved to Morton positions 0, 3, 6. */
std::uint64_t spread(int v) { return (v & 1) | (v & 2) << 2 | (v & 4) << 4; }

std::size_t powerOfTwo(std::size_t atLeast) {
  std::size_t power = 1;
  while (power < atLeast) power *= 2;
  return power;
}

int floorToTile(int voxel) { return voxel & ~(kTileSide - 1); }

}  // namespace

void ScanGrid::cover(const VoxelIndex& lowest, const VoxelIndex& highest, std::size_t maxTiles) {
  std::size_t stride = 1;  // of pages
  for (int axis = 0; axis < 3; ++axis) {
    m_firstVoxel[axis] = floorToTile(lowest[axis] - 1);
    m_firstTile[axis] = (m_firstVoxel[axis] + kKeyOfOrigin) >> 3;
    m_numTiles[axis] = (floorToTile(highest[axis] + 1) - m_firstVoxel[axis]) / kTileSide + 1;
    const auto position = [&](std::size_t page, int tile, int voxel) {
      const std::uint64_t tiles = page * stride * kTilesPerPage + (tile << 2 * axis);
      return tiles * kBitsPerTile + (spread(voxel) << axis);
    };
    m_offsets[axis].resize(static_cast<std::size_t>(m_numTiles[axis]) * kTileSide);
    for (std::size_t i = 0; i < m_offsets[axis].size(); ++i)
      m_offsets[axis][i] = position(i >> 5, i >> 3 & 3, static_cast<int>(i & 7));
    const std::size_t pages = (m_numTiles[axis] + 3) / 4, padded = powerOfTwo(pages);
    m_fields[axis].mask =
        static_cast<std::int64_t>(position(axis < 2 ? padded - 1 : kAllPages, 3, 7));
    stride *= axis < 2 ? padded : pages;
  }
  m_numPages = stride;
  if (m_numPages * kTilesPerPage > maxTiles)
    throw std::length_error(
        "scan too large to insert: " + std::to_string(m_numPages * kTilesPerPage) +
        " tiles of 8 x 8 x 8 voxels, where memory allows " + std::to_string(maxTiles) +
        "; set max_range, if the points are in meters");
  reserve();
}

void ScanGrid::coverLike(const ScanGrid& o) {
  m_firstVoxel = o.m_firstVoxel;
  m_firstTile = o.m_firstTile;
  m_numTiles = o.m_numTiles;
  m_fields = o.m_fields;
  for (int axis = 0; axis < 3; ++axis) m_offsets[axis] = o.m_offsets[axis];
  m_numPages = o.m_numPages;
  reserve();
}

void ScanGrid::reserve() {
  if (m_numPages <= m_capacity) return;
  m_capacity = 0;
  m_memory.reset();
  // calloc: pages that no ray touches cost nothing.
  std::size_t bytes = (m_numPages + 1) * kBytesPerPage;
  m_memory.reset(static_cast<std::byte*>(std::calloc(bytes, 1)));
  if (!m_memory) throw std::bad_alloc();
  void* first = m_memory.get();
  std::align(kBytesPerPage, m_numPages * kBytesPerPage, first, bytes);
  m_words = static_cast<std::uint64_t*>(first);
  m_capacity = m_numPages;
}

MSO_VECTORIZED unsigned countBits(const std::uint64_t* words, int numWords) {
  unsigned bits = 0;  // one instruction a word where it is compiled for a processor that has it
  for (int w = 0; w < numWords; ++w) bits += __builtin_popcountll(words[w]);
  return bits;
}

using semantic_types::LabeledCloud;

namespace {

/** What becomes of points. */
class BeamMaker {
 public:
  BeamMaker(const Eigen::Array3d& origin, const Eigen::Isometry3d& T_map_sensor, double resolution,
            const InsertionOptions& options)
      : m_origin(origin),
        m_rotation(T_map_sensor.linear() / resolution),
        m_maxRange(options.maxRange > 0 ? options.maxRange : std::numeric_limits<double>::max()),
        m_minRange2(options.minRange * options.minRange),
        m_maxRange2(std::min(m_maxRange * m_maxRange, std::numeric_limits<double>::max())) {}

  Beam to(const Eigen::Vector3f& point) const {
    const Eigen::Vector3d p = point.cast<double>();
    const double range2 = p.x() * p.x() + (p.y() * p.y() + p.z() * p.z());
    if (range2 >= m_minRange2 && range2 <= m_maxRange2)
      return beamTo(endOf(p, 1), Beam::Kind::Return);
    if (!std::isfinite(range2)) return {Beam::Kind::NotFinite, m_origin};
    if (range2 < m_minRange2) return {Beam::Kind::Near, m_origin};
    return beamTo(endOf(p, m_maxRange / std::sqrt(range2)), Beam::Kind::Clipped);
  }

 private:
  Eigen::Array3d endOf(const Eigen::Vector3d& p, double scale) const {
    Eigen::Array3d end;
    for (int i = 0; i < 3; ++i)
      end[i] = m_origin[i] +
               (m_rotation(i, 0) * p.x() + (m_rotation(i, 1) * p.y() + m_rotation(i, 2) * p.z())) *
                   scale;
    return end;
  }
  static Beam beamTo(const Eigen::Array3d& end, Beam::Kind kind) {
    return {ScanBeams::insideMap(end) ? kind : Beam::Kind::Outside, end};
  }

  Eigen::Array3d m_origin;
  Eigen::Matrix3d m_rotation;                   ///< meters to voxels, too
  double m_maxRange, m_minRange2, m_maxRange2;  ///< meters; squared
};

/** What beams come to. */
struct BeamSum {
  Eigen::Array3d lowest, highest;
  std::array<std::size_t, 5> numBeams{};  ///< of each kind

  void add(const Beam& b) {
    ++numBeams[static_cast<std::size_t>(b.kind)];
    if (b.isUsed()) lowest = lowest.min(b.end), highest = highest.max(b.end);
  }
  void add(const BeamSum& o) {
    lowest = lowest.min(o.lowest), highest = highest.max(o.highest);
    for (std::size_t i = 0; i < numBeams.size(); ++i) numBeams[i] += o.numBeams[i];
  }
};

void checkSensor(const Eigen::Isometry3d& T_map_sensor, const Eigen::Array3d& origin,
                 double resolution) {
  if (!T_map_sensor.matrix().allFinite())
    throw std::invalid_argument("the sensor's pose has numbers that are not finite");
  if (ScanBeams::insideMap(origin)) return;
  const Eigen::Array3d sensor =
      (100 * T_map_sensor.translation().array()).round() / 100;  // to the cm
  std::ostringstream what;
  const strict_files::ClassicNumbers classic(what);
  what << std::setprecision(10) << "sensor at (" << sensor.x() << ", " << sensor.y() << ", "
       << sensor.z() << ") m is outside the map, which reaches " << kKeyOfOrigin * resolution
       << " m from its origin: subtract the same offset from all poses";
  throw std::out_of_range(what.str());
}

}  // namespace

void ScanBeams::set(const LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor,
                    double resolution, const InsertionOptions& options) {
  for (int axis = 0; axis < 3; ++axis)
    m_origin[axis] = inVoxels(T_map_sensor.translation()[axis], resolution);
  checkSensor(T_map_sensor, m_origin, resolution);
  m_beams.resize(cloud.size());
  const BeamMaker maker(m_origin, T_map_sensor, resolution, options);
  const BeamSum none{m_origin, m_origin};
  std::vector<BeamSum> parts((cloud.size() + kBeamsAtATime - 1) / kBeamsAtATime, none);
  shareOut(options.threads, parts.size(), [&](int, std::size_t part) {
    const std::size_t first = part * kBeamsAtATime, last = first + kBeamsAtATime;
    for (std::size_t i = first; i < std::min(last, cloud.size()); ++i)
      parts[part].add(m_beams[i] = maker.to(cloud.points[i]));
  });
  BeamSum all = none;
  for (const BeamSum& part : parts) all.add(part);
  m_lowest = voxelOf(all.lowest);
  m_highest = voxelOf(all.highest);
  const auto number = [&](Beam::Kind kind) { return all.numBeams[static_cast<std::size_t>(kind)]; };
  m_report = InsertionReport();
  m_report.points = cloud.size();
  m_report.skippedNotFinite = number(Beam::Kind::NotFinite);
  m_report.skippedNear = number(Beam::Kind::Near);
  m_report.skippedOutside = number(Beam::Kind::Outside);
  m_report.beyondRange = number(Beam::Kind::Clipped);
}

namespace {

/** Progress of as many rays as there are lanes along one axis. Which axis is next cannot be
 * predicted: rays go side by side, so that nothing has to be. */
struct AxisLanes {
  Lanes next;         ///< ray parameter (0 begin, 1 end) of the next border
  Lanes delta;        ///< ray parameter from border to border
  LaneBits position;  ///< the axis's part of the bit's position
  LaneBits step;      ///< see ScanGrid::Field
  std::int64_t field;

  MSO_INLINE Lanes deltaWhere(const LaneBits& chosen) const {
    return Lanes(LaneBits(delta) & chosen);
  }
  MSO_INLINE LaneBits movedWhere(const LaneBits& chosen, const LaneBits& at) const {
    return (at + (step & chosen)) & field;
  }
  /** \return the steps to each ray's end */
  MSO_INLINE LaneBits start(const Lanes& end, double begin, const ScanGrid::Field& along) {
    using Ints = int __attribute__((vector_size(16)));
    const int first = static_cast<int>(begin);
    const Lanes length = end - begin;
    const LaneBits isUp = length > 0,
                   last = __builtin_convertvector(__builtin_convertvector(end, Ints), LaneBits);
    const LaneBits moves = last != first;
    const Lanes perBorder = 1.0 / Lanes(LaneBits(length) & INT64_MAX);
    const Lanes toBorder = isUp ? first + 1 - begin + Lanes() : begin - first + Lanes();
    next = moves ? toBorder * perBorder : HUGE_VAL + Lanes();
    delta = Lanes(LaneBits(perBorder) & moves);
    step = moves & (isUp ? along.up() + LaneBits() : along.down() + LaneBits());
    return isUp ? last - first : first - last;
  }
};

/** Progress of as many rays as there are lanes. What changes is copied, so that it stays in
 * registers. */
struct RayProgress {
  AxisLanes &x, &y, &z;
  Lanes nextX = x.next, nextY = y.next, nextZ = z.next;
  LaneBits atX = x.position, atY = y.position, atZ = z.position;

  MSO_INLINE void step(std::uint8_t* bytes) {
    const LaneBits position = atX + atY + atZ;
    const LaneBits isX = (nextX < nextY) & (nextX < nextZ);
    const LaneBits isY = ~isX & (nextY < nextZ);
    const LaneBits isZ = ~(isX | isY);
    nextX += x.deltaWhere(isX), atX = x.movedWhere(isX, atX);
    nextY += y.deltaWhere(isY), atY = y.movedWhere(isY, atY);
    nextZ += z.deltaWhere(isZ), atZ = z.movedWhere(isZ, atZ);
    // Bytes, not words: a voxel's neighbors on the ray are often in the same word, and reading what
    // was just written takes time.
    std::int64_t bits[kNumLanes];
    std::memcpy(bits, &position, sizeof bits);
    for (const std::int64_t bit : bits)
      bytes[bit >> 3] |= static_cast<std::uint8_t>(1 << (bit & 7));
  }
  MSO_INLINE void keep() const {
    x.next = nextX, y.next = nextY, z.next = nextZ;
    x.position = atX, y.position = atY, z.position = atZ;
  }
};

/** Follows twice as many rays as there are lanes: while one half waits for memory, the other goes
 * on. They take about as many steps, so that few lanes wait for others. */
class RayLanes {
 public:
  MSO_INLINE RayLanes(ScanGrid& grid, const Eigen::Array3d& begin)
      : m_grid(grid),
        m_bytes(reinterpret_cast<std::uint8_t*>(grid.words())),
        m_begin(begin),
        m_first(begin.cast<int>()) {
    for (auto& axes : m_axes)
      for (int axis = 0; axis < 3; ++axis) axes[axis].field = grid.field(axis).mask;
  }

  MSO_INLINE void follow(const Eigen::Array3d* ends, std::size_t numRays) {
    const std::vector<const Eigen::Array3d*> order = bySteps(ends, numRays);
    for (std::size_t first = 0; first < order.size(); first += kNumRays) {
      start(order.data() + first);
      run();
    }
  }

 private:
  static constexpr std::size_t kNumRays = 2 * kNumLanes;
  /** Neighbors in a scan would often be in one byte at the same time, and wait for each other. So
   * rays of as many steps follow each other so far apart. */
  static constexpr std::size_t kApart = 16;

  /** The ends of rays, those with the fewest steps first. Before them are rays without any, so that
   * all lanes have one. */
  std::vector<const Eigen::Array3d*> bySteps(const Eigen::Array3d* ends,
                                             std::size_t numRays) const {
    const std::size_t none = (kNumRays - numRays % kNumRays) % kNumRays;
    std::vector<std::size_t> steps(numRays), next(1, none);  // a counting sort
    for (std::size_t i = 0; i < numRays; ++i) {
      steps[i] = static_cast<std::size_t>((ends[i].cast<int>() - m_first).abs().sum());
      if (next.size() < steps[i] + 2) next.resize(steps[i] + 2);
      ++next[steps[i] + 1];
    }
    std::partial_sum(next.begin(), next.end(), next.begin());
    std::vector<const Eigen::Array3d*> order(none + numRays, &m_begin);
    for (std::size_t first = 0; first < kApart; ++first)
      for (std::size_t i = first; i < numRays; i += kApart) order[next[steps[i]]++] = ends + i;
    return order;
  }

  MSO_INLINE void start(const Eigen::Array3d* const* ends) {
    for (int half = 0; half < 2; ++half, ends += kNumLanes) {
      m_left[half] = LaneBits();
      for (int axis = 0; axis < 3; ++axis) {
        const Lanes end = {(*ends[0])[axis], (*ends[1])[axis], (*ends[2])[axis], (*ends[3])[axis]};
        m_left[half] += m_axes[half][axis].start(end, m_begin[axis], m_grid.field(axis));
        m_axes[half][axis].position = partOfFirst(axis) + LaneBits();
      }
    }
  }

  std::int64_t partOfFirst(int axis) const {
    return static_cast<std::int64_t>(m_grid.offsets(axis)[m_first[axis]]);
  }

  MSO_INLINE void run() {
    std::int64_t left[kNumRays], done = 0;
    std::memcpy(left, m_left, sizeof left);
    for (const std::int64_t steps : left) {
      if (steps == done) continue;
      if (done > 0) park(done);
      advance(steps - done);
      done = steps;
    }
  }

  /** Rays that took all their steps stay in the voxel where all begin. */
  MSO_INLINE void park(std::int64_t done) {
    for (int half = 0; half < 2; ++half)
      for (int axis = 0; axis < 3; ++axis) {
        const LaneBits goesOn = m_left[half] > done;
        AxisLanes& a = m_axes[half][axis];
        a.step &= goesOn;
        a.position = goesOn ? a.position : partOfFirst(axis) + LaneBits();
      }
  }

  /** All rays take so many steps. */
  MSO_INLINE void advance(std::int64_t steps) {
    auto& [a, b] = m_axes;
    RayProgress one{a[0], a[1], a[2]}, other{b[0], b[1], b[2]};
    for (std::uint8_t* const bytes = m_bytes; steps > 0; --steps)
      one.step(bytes), other.step(bytes);
    one.keep(), other.keep();
  }

  ScanGrid& m_grid;
  std::uint8_t* m_bytes;
  Eigen::Array3d m_begin;
  Eigen::Array3i m_first;
  AxisLanes m_axes[2][3];
  LaneBits m_left[2];
};

}  // namespace

MSO_VECTORIZED void markRays(ScanGrid& grid, const Eigen::Array3d& begin,
                             const Eigen::Array3d* ends, std::size_t numRays) {
  RayLanes lanes(grid, begin);
  lanes.follow(ends, numRays);
}

}  // namespace semantic_octree
