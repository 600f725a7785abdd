#include <view_information/GainField.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <utility>

namespace view_information {

using semantic_octree::SemanticOcTreeNode;
using semantic_octree::TileChange;

namespace {

constexpr std::uint16_t kUnknown = 65535;
constexpr float kPassUnits = 65534;
constexpr std::uint16_t kFree = 32767;  // pass: more is free
constexpr int kHalf = 256;              // voxels
constexpr int kNumbers = 64;            // values that hold the numbers of these, byte by byte
constexpr float kLeastReach = 1e-3F;    // beyond it what a beam tells does not count

constexpr std::uint64_t kScatters = 0x9E3779B97F4A7C15U;  // the upper bits of its multiples

std::uint32_t bitsOf(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

std::uint16_t upperHalf(float value) {
  return static_cast<std::uint16_t>((bitsOf(value) + 0x8000U) >> 16);
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

  const Voxel& at(int x, int y, int z) const {
    return values[numbers[(x & 3) << 6 | (y & 7) << 3 | (z & 7)]];
  }
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
    const std::array<int, 3> low{from[0] - reach, from[1] - reach, from[2] + view.lowest()},
        high{from[0] + reach, from[1] + reach, from[2] + view.highest() + 1};
    for (std::size_t a = 0; a < 3; ++a) {
      m_low[a] = low[a] >> 3;
      m_size[a] = (high[a] >> 3) - m_low[a] + 1;
    }
    m_halves.resize(static_cast<std::size_t>(2 * m_size[0] * m_size[1] * m_size[2]));
    m_patches.resize(static_cast<std::size_t>(4 * m_size[0] * m_size[1]));
  }

  Gain at(int x, int y, int z) {
    const Voxel& v = stored(x, y, z);
    if (v.pass == kUnknown) return unknown(x, y, z);
    return m_knowsAir && isAir(v) ? Gain{} : unpacked(v);
  }

 private:
  static bool isAir(const Voxel& v) { return v.pass != kUnknown && v.pass > kFree; }
  const Voxel& stored(int x, int y, int z) {
    const int column = ((x >> 2) - 2 * m_low[0]) * m_size[1] + (y >> 3) - m_low[1];
    View& half = m_halves[static_cast<std::size_t>(column * m_size[2] + (z >> 3) - m_low[2])];
    if (!half.numbers) half = View::of(m_field.find(x, y, z));
    return half.at(x, y, z);
  }
  Gain unknown(int x, int y, int z) {
    const int px = (x >> 2) - 2 * m_low[0], py = (y >> 2) - 2 * m_low[1];
    const UnknownPatch*& patch = m_patches[static_cast<std::size_t>(px * 2 * m_size[1] + py)];
    if (!patch) patch = &m_prior.patch(x >> 2, y >> 2);
    if (z >= patch->ground) return patch->at(x, y, z);
    return isAir(stored(x, y, z + 1)) ? patch->belowFree(x, y, z) : patch->at(x, y, z);
  }

  const GainField& m_field;
  UnknownPrior& m_prior;
  bool m_knowsAir;
  std::array<int, 3> m_low{}, m_size{};  ///< tiles
  std::vector<View> m_halves;
  std::vector<const UnknownPatch*> m_patches;
};

GainField::GainField(semantic_octree::SemanticOcTree& map, const Question& question)
    : m_map(map),
      m_question(question),
      m_model(map.numClasses(), map.filterParameters()),
      m_filter(map.numClasses(), map.filterParameters()),
      m_follower(map.follow()),
      m_computed(std::size_t{1} << (64 - kOfComputed)),
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

/** Most leaves are one of few: what was computed last for one with the same hash is kept. Classes
 * of one kind are alike. */
const GainField::Computed& GainField::computed(const SemanticOcTreeNode& leaf) {
  Computed now;
  now.logOdds = leaf.getLogOdds();
  now.hasRecord = leaf.hasClassRecord();
  std::uint64_t hash = bitsOf(now.logOdds) ^ now.hasRecord;
  if (now.hasRecord) now.belief = m_map.belief(leaf);
  for (int i = 0; i < now.belief.count; ++i) {
    now.belief.ids[i] = static_cast<ClassId>(m_question.kinds()[now.belief.ids[i]]);
    hash = (hash ^ bitsOf(now.belief.logOdds[i]) ^ now.belief.ids[i]) * kScatters;
  }
  Computed& last = m_computed[hash * kScatters >> kOfComputed];
  if (last.logOdds == now.logOdds && last.hasRecord == now.hasRecord && last.belief == now.belief)
    return last;
  const auto belief = m_map.belief(leaf);
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

/** \param at the node's lowest voxel in the tile */
void GainField::read(const SemanticOcTreeNode& node, int edge, int at, Tile& tile) {
  if (!node.isLeaf()) {
    const int half = edge / 2;
    for (int i = 0; i < 8; ++i)
      if (const SemanticOcTreeNode child = node.child(i))
        read(child, half, at + (half * (i & 1) << 6 | half * (i >> 1 & 1) << 3 | half * (i >> 2)),
             tile);
    return;
  }
  const Computed& of = computed(node);
  for (int x = 0; x < edge; ++x)
    for (int y = 0; y < edge; ++y)
      for (int z = 0; z < edge; ++z, tile.known += of.known)
        tile.voxels[static_cast<std::size_t>(at + (x << 6 | y << 3 | z))] = of.voxel;
}

GainField::Stored GainField::read(const octomap::OcTreeKey& low) {
  Tile tile;
  tile.voxels.fill({kUnknown, 0});
  const unsigned depth = semantic_octree::kTreeDepth - 3;
  if (const SemanticOcTreeNode node = m_map.search(low, depth)) read(node, kEdge, 0, tile);
  return {{stored(tile.voxels.data()), stored(tile.voxels.data() + kHalf)}, tile.known};
}

/** There are no more values than voxels: a byte numbers them. */
GainField::Half GainField::stored(const Voxel* voxels) {
  constexpr std::size_t kSlots = 512;
  std::array<std::uint16_t, kSlots> slots{};  // number of a value and 1; 0: none
  Half half(kNumbers);
  std::array<unsigned char, kHalf> numbers;
  for (std::size_t i = 0; i < kHalf; ++i) {
    if (i > 0 && voxels[i] == voxels[i - 1]) {
      numbers[i] = numbers[i - 1];
      continue;
    }
    const std::uint64_t bits = std::uint64_t{voxels[i].pass} << 16 | voxels[i].gain;
    std::size_t slot = bits * kScatters >> 55;
    while (slots[slot] != 0 && !(half[kNumbers + slots[slot] - 1U] == voxels[i]))
      slot = (slot + 1) % kSlots;
    if (slots[slot] == 0) {
      half.push_back(voxels[i]);
      slots[slot] = static_cast<std::uint16_t>(half.size() - kNumbers);
    }
    numbers[i] = static_cast<unsigned char>(slots[slot] - 1);
  }
  if (half.size() == kNumbers + 1) return {half.back()};
  std::memcpy(half.data(), numbers.data(), sizeof numbers);
  half.shrink_to_fit();
  return half;
}

const GainField::Half* GainField::find(int x, int y, int z) const {
  const auto found = m_tiles.find(keyOf(x >> 3, y >> 3, z >> 3));
  return found == m_tiles.end() ? nullptr : &found->second.halves[x >> 2 & 1];
}

std::optional<Gain> GainField::at(const octomap::OcTreeKey& key) const {
  const Voxel& v = View::of(find(key[0], key[1], key[2])).at(key[0], key[1], key[2]);
  if (v.pass == kUnknown) return {};
  return unpacked(v);
}

template <class Visit>
void GainField::lookAround(const ViewTemplate& view, UnknownPrior& prior,
                           const octomap::OcTreeKey& from, Visit visit) const {
  Surroundings around(*this, prior, from, view);
  const auto& voxels = view.voxels();
  std::vector<float> leaves(static_cast<std::size_t>(view.reach()) + 1, 1);  // by shell
  for (std::size_t i = 1; i < voxels.size();) {
    const ViewTemplate::Voxel& v = voxels[i];
    const float reached = leaves[v.shell - 1U];
    const Gain gain = around.at(from[0] + v.x, from[1] + v.y, from[2] + v.z);
    visit(v, reached, gain.gain);
    leaves[v.shell] = reached * gain.pass;
    i = leaves[v.shell] < kLeastReach ? static_cast<std::size_t>(v.next) : i + 1;
  }
}

SectorGains GainField::sweep(const ViewTemplate& view, UnknownPrior& prior,
                             const octomap::OcTreeKey& from) const {
  SectorGains gains{};
  lookAround(view, prior, from, [&](const ViewTemplate::Voxel& v, float reached, float gain) {
    gains[v.heading] += view.weight(v) * reached * gain;
  });
  return gains;
}

Bounds GainField::growth(const ViewTemplate& view, UnknownPrior& prior,
                         const octomap::OcTreeKey& from, int sector) const {
  std::vector<std::vector<double>> beliefs;
  std::vector<double> reach, counts;
  lookAround(view, prior, from, [&](const ViewTemplate::Voxel& v, float reached, float) {
    if (!view.sees(v, sector)) return;
    reach.push_back(static_cast<double>(reached));
    counts.push_back(static_cast<double>(view.weight(v)));
    beliefs.push_back(m_nothingKnown);
    const auto leaf =
        m_map.search(semantic_octree::octomapKey(from[0] + v.x, from[1] + v.y, from[2] + v.z));
    if (leaf) m_map.belief(leaf).distribution(m_map.numClasses(), beliefs.back().data());
  });
  if (reach.empty()) return {};
  const Bounds ofEqualShares = growthOfTree(m_question, m_model, beliefs, reach, counts);
  const double cells = std::accumulate(counts.begin(), counts.end(), 0.0);
  return {cells * ofEqualShares.lower, cells * ofEqualShares.upper};
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

}  // namespace view_information
