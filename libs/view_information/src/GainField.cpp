#include <view_information/GainField.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

namespace view_information {

using semantic_octree::SemanticOcTreeNode;
using semantic_octree::TileChange;
using Offset = std::array<int, 3>;

namespace {

constexpr std::uint16_t kUnknown = 65535;
constexpr float kPassUnits = 65534;
constexpr std::uint16_t kFree = 32767;  // pass: more is free
constexpr int kHalf = 256;              // voxels
constexpr int kNumbers = 64;            // values that hold the numbers of these, byte by byte
constexpr float kLeastReach = 1e-3F;    // beyond it what a beam tells does not count

std::uint16_t upperHalf(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return static_cast<std::uint16_t>((bits + 0x8000U) >> 16);
}

/** In half a tile. */
int indexOf(int x, int y, int z) { return (x & 3) << 6 | (y & 7) << 3 | (z & 7); }

float ofUpperHalf(std::uint16_t half) {
  const std::uint32_t bits = std::uint32_t{half} << 16;
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace

/** Inline functions are made part of the sweep, others of a shared library are not. */
inline Gain GainField::unpacked(const Voxel& voxel) {
  return {static_cast<float>(voxel.pass) * (1 / kPassUnits), ofUpperHalf(voxel.gain)};
}

inline const GainField::Voxel& GainField::voxelIn(const Half& half, int i) {
  if (half.size() == 1) return half.front();
  return half[kNumbers + reinterpret_cast<const unsigned char*>(half.data())[i]];
}

/** The tiles and the patches of the prior around a place, each looked up when it is needed. */
class GainField::Surroundings {
 public:
  Surroundings(const GainField& field, UnknownPrior& prior, const octomap::OcTreeKey& from,
               const ViewTemplate& view)
      : m_field(field), m_prior(prior), m_knowsAir(prior.knowsAir()) {
    const int reach = view.reach();
    const std::array<int, 3> low{from[0] - reach, from[1] - reach, from[2] + view.lowest()},
        high{from[0] + reach, from[1] + reach, from[2] + view.highest() + 1};
    for (std::size_t a = 0; a < 3; ++a) {
      m_low[a] = low[a] >> 3;
      m_size[a] = (high[a] >> 3) - m_low[a] + 1;
    }
    m_tiles.resize(static_cast<std::size_t>(m_size[0] * m_size[1] * m_size[2]));
    m_patches.resize(static_cast<std::size_t>(4 * m_size[0] * m_size[1]));
  }

  Gain at(int x, int y, int z) {
    const Voxel* v = known(x, y, z);
    if (!v) return unknown(x, y, z);
    Gain gain = unpacked(*v);
    if (m_knowsAir && std::signbit(gain.gain)) gain.gain = 0;
    gain.gain = std::abs(gain.gain);
    return gain;
  }

 private:
  struct Place {
    const Stored* tile = nullptr;
    bool isKnown = false;  ///< whether there is a tile
  };
  /** Null: nothing is known. */
  const Voxel* known(int x, int y, int z) {
    Place& place = m_tiles[static_cast<std::size_t>(
        (((x >> 3) - m_low[0]) * m_size[1] + (y >> 3) - m_low[1]) * m_size[2] + (z >> 3) -
        m_low[2])];
    if (!std::exchange(place.isKnown, true)) place.tile = m_field.find(x >> 3, y >> 3, z >> 3);
    if (!place.tile) return nullptr;
    const Voxel& v = voxelIn((*place.tile)[x >> 2 & 1], indexOf(x, y, z));
    return v.pass == kUnknown ? nullptr : &v;
  }
  Gain unknown(int x, int y, int z) {
    const int px = (x >> 2) - 2 * m_low[0], py = (y >> 2) - 2 * m_low[1];
    const UnknownPatch*& patch = m_patches[static_cast<std::size_t>(px * 2 * m_size[1] + py)];
    if (!patch) patch = &m_prior.patch(x >> 2, y >> 2);
    if (z >= patch->ground) return patch->at(x, y, z);
    const Voxel* above = known(x, y, z + 1);
    const bool isBelowFree = above && above->pass > kFree;
    return isBelowFree ? patch->belowFree(x, y, z) : patch->at(x, y, z);
  }

  const GainField& m_field;
  UnknownPrior& m_prior;
  bool m_knowsAir;
  std::array<int, 3> m_low{}, m_size{};  ///< tiles
  std::vector<Place> m_tiles;
  std::vector<const UnknownPatch*> m_patches;
};

GainField::GainField(semantic_octree::SemanticOcTree& map, const Question& question)
    : m_map(map),
      m_question(question),
      m_model(map.numClasses(), map.filterParameters()),
      m_filter(map.numClasses(), map.filterParameters()),
      m_follower(map.follow()) {}

GainField::Voxel GainField::packed(const Gain& gain) {
  return {static_cast<std::uint16_t>(std::lround(gain.pass * kPassUnits)), upperHalf(gain.gain)};
}

TileChange GainField::update() {
  TileChange change = m_follower.tiles();
  if (change.all) m_tiles.clear();
  for (const octomap::OcTreeKey& low : change.tiles) {
    const Tile tile = read(low);
    m_tiles[keyOf(low[0] >> 3, low[1] >> 3, low[2] >> 3)] = {stored(tile.data()),
                                                             stored(tile.data() + kHalf)};
  }
  return change;
}

/** The gain of what has no class record is stored with a minus: who knows that it is air asks no
 * more of it. */
GainField::Voxel GainField::voxelOf(const SemanticOcTreeNode& leaf) {
  const double floor = m_map.filterParameters().minOccupancy;
  const auto gainOf = [&](const semantic_octree::ClassBelief<float>& belief) {
    const double fall = std::max(0.0, m_question.fallThrough(m_filter, m_model, belief));
    return Gain{static_cast<float>(passThrough(leaf.getOccupancy(), floor)),
                static_cast<float>(fall)};
  };
  if (leaf.hasClassRecord()) return packed(gainOf(m_map.belief(leaf)));
  const auto [found, isNew] = m_uniform.try_emplace(leaf.getLogOdds());
  if (isNew) {
    Gain gain = gainOf(m_filter.uniform(leaf.getLogOdds()));
    if (!m_map.isNodeOccupied(leaf)) gain.gain = -gain.gain;
    found->second = packed(gain);
  }
  return found->second;
}

GainField::Tile GainField::read(const octomap::OcTreeKey& low) {
  Tile tile;
  tile.fill({kUnknown, 0});
  const octomap::OcTreeKey high = semantic_octree::octomapKey(low[0] + 7, low[1] + 7, low[2] + 7);
  for (auto leaf = m_map.begin_leafs_bbx(low, high); leaf != m_map.end_leafs_bbx(); ++leaf) {
    const Voxel voxel = voxelOf(*leaf);
    const octomap::OcTreeKey first = leaf.getIndexKey();
    const int edge = semantic_octree::edgeAtDepth(static_cast<int>(leaf.getDepth()));
    std::array<int, 3> from{}, to{};
    for (unsigned a = 0; a < 3; ++a) {
      from[a] = std::max<int>(first[a], low[a]) - low[a];
      to[a] = std::min<int>(first[a] + edge, low[a] + kEdge) - low[a];
    }
    for (int x = from[0]; x < to[0]; ++x)
      for (int y = from[1]; y < to[1]; ++y)
        for (int z = from[2]; z < to[2]; ++z)
          tile[static_cast<std::size_t>(x << 6 | y << 3 | z)] = voxel;
  }
  return tile;
}

/** There are no more values than voxels: a byte numbers them. */
GainField::Half GainField::stored(const Voxel* voxels) {
  std::vector<Voxel> values(voxels, voxels + kHalf);
  const auto isBefore = [](const Voxel& a, const Voxel& b) {
    return a.pass != b.pass ? a.pass < b.pass : a.gain < b.gain;
  };
  std::sort(values.begin(), values.end(), isBefore);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.size() == 1) return values;
  Half half(kNumbers + values.size());
  std::copy(values.begin(), values.end(), half.begin() + kNumbers);
  auto* numbers = reinterpret_cast<unsigned char*>(half.data());
  for (int i = 0; i < kHalf; ++i)
    numbers[i] = static_cast<unsigned char>(
        std::lower_bound(values.begin(), values.end(), voxels[i], isBefore) - values.begin());
  return half;
}

const GainField::Stored* GainField::find(int x, int y, int z) const {
  const auto found = m_tiles.find(keyOf(x, y, z));
  return found == m_tiles.end() ? nullptr : &found->second;
}

std::optional<Gain> GainField::at(const octomap::OcTreeKey& key) const {
  const Stored* tile = find(key[0] >> 3, key[1] >> 3, key[2] >> 3);
  if (!tile) return {};
  const Voxel& v = voxelIn((*tile)[key[0] >> 2 & 1], indexOf(key[0], key[1], key[2]));
  if (v.pass == kUnknown) return {};
  const Gain gain = unpacked(v);
  return Gain{gain.pass, std::abs(gain.gain)};
}

SectorGains GainField::sweep(const ViewTemplate& view, UnknownPrior& prior,
                             const octomap::OcTreeKey& from) {
  Surroundings around(*this, prior, from, view);
  SectorGains gains{};
  const auto& voxels = view.voxels();
  m_leaves.resize(voxels.size());
  m_leaves[0] = 1;
  for (std::size_t i = 1; i < voxels.size();) {
    const ViewTemplate::Voxel& v = voxels[i];
    const float reached = m_leaves[static_cast<std::size_t>(v.parent)];
    const Gain gain = around.at(from[0] + v.x, from[1] + v.y, from[2] + v.z);
    gains[v.heading] += reached * gain.gain;
    m_leaves[i] = reached * gain.pass;
    i = m_leaves[i] < kLeastReach ? static_cast<std::size_t>(v.next) : i + 1;
  }
  return gains;
}

std::size_t GainField::memoryUsage() const {
  constexpr std::size_t kOfBlock = 2 * sizeof(void*);  // of the heap
  constexpr std::size_t kOfEntry =
      sizeof(std::uint64_t) + sizeof(Stored) + 2 * sizeof(void*) + kOfBlock;
  std::size_t bytes = m_tiles.size() * kOfEntry + m_leaves.capacity() * sizeof(float);
  for (const auto& [key, tile] : m_tiles)
    for (const Half& half : tile) bytes += half.capacity() * sizeof(Voxel) + kOfBlock;
  return bytes;
}

namespace {

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

/** The voxels of the shape, those through which they are seen, and the sensor's; all are marked. */
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
