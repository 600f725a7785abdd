#include <view_information/GainField.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>

namespace view_information {

using semantic_octree::SemanticOcTreeNode;
using semantic_octree::TileChange;
using Offset = std::array<int, 3>;

namespace {

/** Up to here a shape without beams has all its voxels. Beyond, it has one beam through each that
 * is there, for unknown space is predicted more coarsely than that. */
constexpr double kAll = 5;  // m

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

/** The numbers of half a tile's values, and the values: no numbers, if it is not looked up yet. */
struct GainField::View {
  const unsigned char* numbers = nullptr;
  const Voxel* values = nullptr;

  const Voxel& at(int i) const { return values[numbers[i]]; }
  /** Null: nothing is known. */
  static View of(const Half* half) {
    static constexpr unsigned char kFirst[kHalf] = {};
    static constexpr Voxel kNothing{kUnknown, 0};
    if (!half) return {kFirst, &kNothing};
    if (half->size() == 1) return {kFirst, half->data()};
    return {reinterpret_cast<const unsigned char*>(half->data()), half->data() + kNumbers};
  }
};

/** The tiles and the patches of the prior around a place, each looked up when it is needed. */
class GainField::Surroundings {
 public:
  Surroundings(const GainField& field, UnknownPrior& prior, const octomap::OcTreeKey& from,
               const ViewTemplate& view)
      : m_field(field), m_prior(prior), m_knowsAir(prior.knowsAir()) {
    const int reach = view.reach();
    m_from = {from[0] - reach, from[1] - reach, from[2] + view.lowest()};
    const std::array<int, 3> to{from[0] + reach, from[1] + reach, from[2] + view.highest() + 1};
    for (std::size_t a = 0; a < 3; ++a) {
      m_low[a] = m_from[a] >> 3;
      m_size[a] = (to[a] >> 3) - m_low[a] + 1;
    }
    const int ofX = m_size[1] * m_size[2], ofY = m_size[2];
    for (int x = m_from[0]; x <= to[0]; ++x)
      m_steps[0].push_back({((x >> 2) - 2 * m_low[0]) * ofX, (x & 3) << 6});
    for (int y = m_from[1]; y <= to[1]; ++y)
      m_steps[1].push_back({((y >> 3) - m_low[1]) * ofY, (y & 7) << 3});
    for (int z = m_from[2]; z <= to[2]; ++z) m_steps[2].push_back({(z >> 3) - m_low[2], z & 7});
    m_halves.resize(static_cast<std::size_t>(2 * m_size[0] * ofX));
    m_patches.resize(static_cast<std::size_t>(4 * m_size[0] * m_size[1]));
  }

  Gain at(int x, int y, int z) {
    const Voxel& v = stored(x, y, z);
    if (v.pass == kUnknown) return unknown(x, y, z);
    Gain gain = unpacked(v);
    if (m_knowsAir && std::signbit(gain.gain)) gain.gain = 0;
    gain.gain = std::abs(gain.gain);
    return gain;
  }

 private:
  /** Along one axis: what a key adds to the number of a half, and to that of a voxel in it. */
  struct Step {
    int half, voxel;
  };
  const Step& step(std::size_t axis, int key) const {
    return m_steps[axis][static_cast<std::size_t>(key - m_from[axis])];
  }
  const Voxel& stored(int x, int y, int z) {
    const Step &a = step(0, x), &b = step(1, y), &c = step(2, z);
    View& half = m_halves[static_cast<std::size_t>(a.half + b.half + c.half)];
    if (!half.numbers) half = View::of(m_field.find(x, y, z));
    return half.at(a.voxel + b.voxel + c.voxel);
  }
  Gain unknown(int x, int y, int z) {
    const int px = (x >> 2) - 2 * m_low[0], py = (y >> 2) - 2 * m_low[1];
    const UnknownPatch*& patch = m_patches[static_cast<std::size_t>(px * 2 * m_size[1] + py)];
    if (!patch) patch = &m_prior.patch(x >> 2, y >> 2);
    if (z >= patch->ground) return patch->at(x, y, z);
    const Voxel& above = stored(x, y, z + 1);
    const bool isBelowFree = above.pass != kUnknown && above.pass > kFree;
    return isBelowFree ? patch->belowFree(x, y, z) : patch->at(x, y, z);
  }

  const GainField& m_field;
  UnknownPrior& m_prior;
  bool m_knowsAir;
  std::array<int, 3> m_from{}, m_low{}, m_size{};  ///< first keys; first tiles, and how many
  std::array<std::vector<Step>, 3> m_steps;
  std::vector<View> m_halves;
  std::vector<const UnknownPatch*> m_patches;
};

GainField::GainField(semantic_octree::SemanticOcTree& map, const Question& question)
    : m_map(map),
      m_question(question),
      m_model(map.numClasses(), map.filterParameters()),
      m_filter(map.numClasses(), map.filterParameters()),
      m_follower(map.follow()),
      m_computed(kComputed),
      m_nothingKnown(nothingKnown(map.numClasses())) {}

GainField::Voxel GainField::packed(const Gain& gain) {
  return {static_cast<std::uint16_t>(std::lround(gain.pass * kPassUnits)), upperHalf(gain.gain)};
}

TileChange GainField::update() {
  TileChange change = m_follower.tiles();
  if (change.all) m_tiles.clear(), m_known = 0;
  for (const octomap::OcTreeKey& low : change.tiles) {
    Stored& tile = m_tiles[keyOf(low[0] >> 3, low[1] >> 3, low[2] >> 3)];
    m_known -= static_cast<double>(tile.known);
    tile = read(low);
    m_known += static_cast<double>(tile.known);
  }
  return change;
}

/** Most voxels have one of few beliefs: what was computed last for one with the same hash is kept.
 * Classes of one kind are alike. */
const GainField::Computed& GainField::computed(const SemanticOcTreeNode& leaf) {
  const semantic_octree::ClassBelief<float> belief = m_map.belief(leaf);
  Computed now{belief, leaf.getLogOdds(), {}};
  const std::hash<float> hashOf;
  std::size_t hash = hashOf(now.logOdds);
  for (int i = 0; i < belief.count; ++i) {
    now.belief.ids[i] = static_cast<ClassId>(m_question.kinds()[belief.ids[i]]);
    hash = (hash ^ hashOf(belief.logOdds[i]) ^ now.belief.ids[i]) * 0x9E3779B97F4A7C15U;
  }
  Computed& last = m_computed[(hash ^ hash >> 32) % kComputed];
  if (last.logOdds == now.logOdds && last.belief == now.belief) return last;
  const double fall = std::max(0.0, m_question.fallThrough(m_filter, m_model, belief));
  const double pass = passThrough(leaf.getOccupancy(), m_map.filterParameters().minOccupancy);
  now.voxel = packed({static_cast<float>(pass), static_cast<float>(fall)});
  if (m_map.isNodeOccupied(leaf)) {
    std::vector<double> p(m_nothingKnown.size());
    belief.distribution(m_map.numClasses(), p.data());
    now.known = static_cast<float>(m_question.divergence(p.data(), m_nothingKnown.data()));
  }
  return last = now;
}

/** The gain of what has no class record is stored with a minus: who knows that it is air asks no
 * more of it. */
GainField::Stored GainField::read(const octomap::OcTreeKey& low) {
  constexpr std::uint16_t kMinus = 0x8000;
  std::array<Voxel, kVoxels> voxels;
  voxels.fill({kUnknown, 0});
  Stored tile;
  const octomap::OcTreeKey high = semantic_octree::octomapKey(low[0] + 7, low[1] + 7, low[2] + 7);
  for (auto leaf = m_map.begin_leafs_bbx(low, high); leaf != m_map.end_leafs_bbx(); ++leaf) {
    const Computed& of = computed(*leaf);
    Voxel voxel = of.voxel;
    if (!leaf->hasClassRecord() && !m_map.isNodeOccupied(*leaf)) voxel.gain |= kMinus;
    const octomap::OcTreeKey first = leaf.getIndexKey();
    const int edge = semantic_octree::edgeAtDepth(static_cast<int>(leaf.getDepth()));
    std::array<int, 3> from{}, to{};
    for (unsigned a = 0; a < 3; ++a) {
      from[a] = std::max<int>(first[a], low[a]) - low[a];
      to[a] = std::min<int>(first[a] + edge, low[a] + kEdge) - low[a];
    }
    for (int x = from[0]; x < to[0]; ++x)
      for (int y = from[1]; y < to[1]; ++y)
        for (int z = from[2]; z < to[2]; ++z, tile.known += of.known)
          voxels[static_cast<std::size_t>(x << 6 | y << 3 | z)] = voxel;
  }
  tile.halves = {stored(voxels.data()), stored(voxels.data() + kHalf)};
  return tile;
}

/** There are no more values than voxels: a byte numbers them. */
GainField::Half GainField::stored(const Voxel* voxels) {
  std::vector<Voxel> values;
  std::unique_copy(voxels, voxels + kHalf, std::back_inserter(values));
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

const GainField::Half* GainField::find(int x, int y, int z) const {
  const auto found = m_tiles.find(keyOf(x >> 3, y >> 3, z >> 3));
  return found == m_tiles.end() ? nullptr : &found->second.halves[x >> 2 & 1];
}

std::optional<Gain> GainField::at(const octomap::OcTreeKey& key) const {
  const int inHalf = (key[0] & 3) << 6 | (key[1] & 7) << 3 | (key[2] & 7);
  const Voxel& v = View::of(find(key[0], key[1], key[2])).at(inHalf);
  if (v.pass == kUnknown) return {};
  const Gain gain = unpacked(v);
  return Gain{gain.pass, std::abs(gain.gain)};
}

SectorGains GainField::sweep(const ViewTemplate& view, UnknownPrior& prior,
                             const octomap::OcTreeKey& from) {
  Surroundings around(*this, prior, from, view);
  SectorGains gains{};
  const auto& voxels = view.voxels();
  std::vector<float> leaves(static_cast<std::size_t>(view.reach()) + 1, 1);  // by shell
  for (std::size_t i = 1; i < voxels.size();) {
    const ViewTemplate::Voxel& v = voxels[i];
    const float reached = leaves[v.shell - 1U];
    const Gain gain = around.at(from[0] + v.x, from[1] + v.y, from[2] + v.z);
    gains[v.heading] += view.weight(v) * reached * gain.gain;
    leaves[v.shell] = reached * gain.pass;
    i = leaves[v.shell] < kLeastReach ? static_cast<std::size_t>(v.next) : i + 1;
  }
  return gains;
}

std::size_t GainField::memoryUsage() const {
  constexpr std::size_t kOfBlock = 2 * sizeof(void*);  // of the heap
  constexpr std::size_t kOfEntry =
      sizeof(std::uint64_t) + sizeof(Stored) + 2 * sizeof(void*) + kOfBlock;
  std::size_t bytes = m_tiles.size() * kOfEntry;
  for (const auto& [key, tile] : m_tiles)
    for (const Half& half : tile.halves) bytes += half.capacity() * sizeof(Voxel) + kOfBlock;
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

/** The voxels of the shape, those through which they are seen, and the sensor's; all are marked.
 * \param counts by shell: voxels of the shape */
std::vector<Offset> offsetsOf(const ViewShape& shape, int reach, double voxelSize,
                              OffsetTable& marked, std::vector<int>& counts) {
  std::vector<Offset> all{{0, 0, 0}};
  marked.at(all.front()) = 0;
  const auto add = [&](const Offset& farthest) {
    for (Offset v = farthest; marked.at(v) < 0; v = parentOf(v)) marked.at(v) = 0, all.push_back(v);
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
  requireWithin("range", shape.range, voxelSize, 1000 * voxelSize);
  requireWithin("lowest", shape.lowest, -90, shape.highest);
  requireWithin("highest", shape.highest, shape.lowest, 90);
  requireWithin("width", shape.width, 1, 360);
  m_reach = static_cast<int>(shape.range / voxelSize);
  OffsetTable numbers(m_reach);
  std::vector<int> counts(static_cast<std::size_t>(m_reach) + 1, 0), kept = counts;
  std::vector<Offset> order = offsetsOf(shape, m_reach, voxelSize, numbers, counts);
  std::sort(order.begin(), order.end(), [](const Offset& a, const Offset& b) {
    return std::make_pair(shellOf(a), a) < std::make_pair(shellOf(b), b);
  });
  for (std::size_t i = 0; i < order.size(); ++i) numbers.at(order[i]) = static_cast<int>(i);
  std::vector<std::size_t> parents(order.size(), 0);
  std::vector<std::int32_t> sizes(order.size(), 1);  // with all behind it
  for (std::size_t i = order.size() - 1; i > 0; --i) {
    parents[i] = static_cast<std::size_t>(numbers.at(parentOf(order[i])));
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
