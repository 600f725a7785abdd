#include <view_information/GainField.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace view_information {

using semantic_octree::SemanticOcTreeNode;
using semantic_octree::TileChange;

namespace {

constexpr std::uint16_t kUnknown = 65535;
constexpr float kPassUnits = 65534;
constexpr std::int32_t kNowhere = -1;
constexpr float kLeastReach = 1e-3F;  // beyond it what a beam tells does not count

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

/** The tiles and the patches of the prior around a place, each looked up once. */
class GainField::Surroundings {
 public:
  Surroundings(const GainField& field, UnknownPrior& prior, const octomap::OcTreeKey& from,
               int reach)
      : m_prior(prior), m_knowsAir(prior.knowsAir()) {
    for (std::size_t a = 0; a < 3; ++a) {
      m_low[a] = (from[static_cast<unsigned>(a)] - reach) >> 3;
      m_size[a] = ((from[static_cast<unsigned>(a)] + reach) >> 3) - m_low[a] + 1;
    }
    for (int x = 0; x < m_size[0]; ++x)
      for (int y = 0; y < m_size[1]; ++y)
        for (int z = 0; z < m_size[2]; ++z)
          m_tiles.push_back(field.find(m_low[0] + x, m_low[1] + y, m_low[2] + z));
    m_patches.resize(static_cast<std::size_t>(4 * m_size[0] * m_size[1]));
  }

  Gain at(int x, int y, int z) {
    const Tile* tile = m_tiles[indexOf(x >> 3, y >> 3, z >> 3)];
    if (!tile) return unknown(x, y, z);
    const Voxel& v = (*tile)[static_cast<std::size_t>((x & 7) << 6 | (y & 7) << 3 | (z & 7))];
    if (v.pass == kUnknown) return unknown(x, y, z);
    Gain gain = unpacked(v);
    if (m_knowsAir && std::signbit(gain.gain)) gain.gain = 0;
    gain.gain = std::abs(gain.gain);
    return gain;
  }

 private:
  std::size_t indexOf(int x, int y, int z) const {
    return static_cast<std::size_t>(((x - m_low[0]) * m_size[1] + y - m_low[1]) * m_size[2] + z -
                                    m_low[2]);
  }
  Gain unknown(int x, int y, int z) {
    const int px = (x >> 2) - 2 * m_low[0], py = (y >> 2) - 2 * m_low[1];
    const UnknownPatch*& patch = m_patches[static_cast<std::size_t>(px * 2 * m_size[1] + py)];
    if (!patch) patch = &m_prior.patch(x >> 2, y >> 2);
    return patch->at(x, y, z);
  }

  UnknownPrior& m_prior;
  bool m_knowsAir;
  std::array<int, 3> m_low{}, m_size{};  ///< tiles
  std::vector<const Tile*> m_tiles;
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

Gain GainField::unpacked(const Voxel& voxel) {
  return {static_cast<float>(voxel.pass) * (1 / kPassUnits), ofUpperHalf(voxel.gain)};
}

TileChange GainField::update() {
  TileChange change = m_follower.tiles();
  if (change.all) m_tiles.clear(), m_stored.clear(), m_unused.clear();
  for (const octomap::OcTreeKey& low : change.tiles)
    put(keyOf(low[0] >> 3, low[1] >> 3, low[2] >> 3), read(low));
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

void GainField::put(std::uint64_t key, const Tile& tile) {
  std::int32_t& place = m_tiles.try_emplace(key, kNowhere).first->second;
  const bool isSame =
      std::all_of(tile.begin(), tile.end(), [&](const Voxel& v) { return v == tile[0]; });
  if (isSame) {
    if (place >= 0) m_unused.push_back(place);
    place = ~numberOfSame(tile);
    return;
  }
  if (place < 0) place = unusedPlace();
  m_stored[static_cast<std::size_t>(place)] = tile;
}

std::int32_t GainField::numberOfSame(const Tile& tile) {
  const std::uint32_t voxel = std::uint32_t{tile[0].pass} << 16 | tile[0].gain;
  const auto next = static_cast<std::int32_t>(m_same.size());
  const auto [found, isNew] = m_sameByVoxel.try_emplace(voxel, next);
  if (isNew) m_same.push_back(tile);
  return found->second;
}

std::int32_t GainField::unusedPlace() {
  if (m_unused.empty()) {
    m_stored.emplace_back();
    return static_cast<std::int32_t>(m_stored.size() - 1);
  }
  const std::int32_t place = m_unused.back();
  m_unused.pop_back();
  return place;
}

const GainField::Tile* GainField::find(int x, int y, int z) const {
  const auto found = m_tiles.find(keyOf(x, y, z));
  if (found == m_tiles.end()) return nullptr;
  const std::int32_t place = found->second;
  return place >= 0 ? &m_stored[static_cast<std::size_t>(place)]
                    : &m_same[static_cast<std::size_t>(~place)];
}

std::optional<Gain> GainField::at(const octomap::OcTreeKey& key) const {
  const Tile* tile = find(key[0] >> 3, key[1] >> 3, key[2] >> 3);
  if (!tile) return {};
  const Voxel& v =
      (*tile)[static_cast<std::size_t>((key[0] & 7) << 6 | (key[1] & 7) << 3 | (key[2] & 7))];
  if (v.pass == kUnknown) return {};
  const Gain gain = unpacked(v);
  return Gain{gain.pass, std::abs(gain.gain)};
}

SectorGains GainField::sweep(const ViewTemplate& view, UnknownPrior& prior,
                             const octomap::OcTreeKey& from) {
  Surroundings around(*this, prior, from, view.reach());
  SectorGains gains{};
  const auto& voxels = view.voxels();
  m_leaves.resize(voxels.size());
  m_leaves[0] = 1;
  for (std::size_t i = 1; i < voxels.size(); ++i) {
    const ViewTemplate::Voxel& v = voxels[i];
    const float reached = m_leaves[static_cast<std::size_t>(v.parent)];
    m_leaves[i] = 0;
    if (reached < kLeastReach) continue;
    const Gain gain = around.at(from[0] + v.x, from[1] + v.y, from[2] + v.z);
    gains[v.heading] += reached * gain.gain;
    m_leaves[i] = reached * gain.pass;
  }
  return gains;
}

std::size_t GainField::memoryUsage() const {
  constexpr std::size_t kOfEntry =
      sizeof(std::uint64_t) + sizeof(std::uint32_t) + 3 * sizeof(void*);
  return (m_stored.size() + m_same.capacity()) * sizeof(Tile) + m_tiles.size() * kOfEntry +
         m_leaves.capacity() * sizeof(float);
}

}  // namespace view_information
