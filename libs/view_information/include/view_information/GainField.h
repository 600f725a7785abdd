#pragma once
#include <semantic_octree/MapFollower.h>
#include <semantic_octree/SemanticOcTree.h>
#include <view_information/UnknownPrior.h>

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <unordered_map>
#include <vector>

namespace view_information {

/** What a sensor sees from a place, whatever its heading: between two elevations. */
struct ViewShape {
  double range = 10;                  ///< meters
  double lowest = -45, highest = 15;  ///< elevations, degrees
  double width = 80;  ///< field of view around the heading, degrees; 360: all around
};

/** The voxels of a ViewShape in all headings, each with the one through which it is seen. */
class ViewTemplate {
 public:
  static constexpr int kHeadings = 36;

  /** \param voxelSize meters \throw std::invalid_argument naming what is out of range */
  ViewTemplate(const ViewShape& shape, double voxelSize);

  const ViewShape& shape() const { return m_shape; }
  struct Voxel {
    std::int16_t x, y, z;  ///< from the sensor's
    std::uint8_t heading;  ///< in which of kHeadings sectors, from -180 degrees on
    std::int32_t parent;   ///< comes before; of the first one, the sensor's: 0
  };
  const std::vector<Voxel>& voxels() const { return m_voxels; }
  int reach() const { return m_reach; }  ///< largest difference along an axis

 private:
  ViewShape m_shape;
  int m_reach = 0;
  std::vector<Voxel> m_voxels;
};

/** What is gained by sector of ViewTemplate::kHeadings, nats. */
using SectorGains = std::array<float, ViewTemplate::kHeadings>;
/** What a view gains that looks along a sector's middle. */
double gainOfHeading(const SectorGains& gains, int sector, double width);
/** The heading of a sector's middle, radians. */
double headingOf(int sector);

/** What observing each known voxel of a map gains once more, and how far beams get through it:
 * four bytes a voxel, in tiles of 8 x 8 x 8 that follow the map's changes. Tiles that are the same
 * throughout are kept once. Not thread safe; the map must not change during a call. */
class GainField {
 public:
  /** \param map must outlive this. */
  GainField(semantic_octree::SemanticOcTree& map, const Question& question);

  /** Follows the map. \return what changed since the last call */
  semantic_octree::TileChange update();
  /** Nothing where the map knows nothing. */
  std::optional<Gain> at(const octomap::OcTreeKey& key) const;
  /** What views from a voxel gain: each voxel counts once, as surely as it is reached. */
  SectorGains sweep(const ViewTemplate& view, UnknownPrior& prior, const octomap::OcTreeKey& from);

  const Question& question() const { return m_question; }
  std::size_t numTiles() const { return m_tiles.size(); }
  /** Bytes. */
  std::size_t memoryUsage() const;

 private:
  static constexpr int kEdge = 8, kVoxels = kEdge * kEdge * kEdge;
  struct Voxel {
    std::uint16_t pass, gain;  ///< pass in 65534ths, 65535: not known; gain: a float's upper half
    bool operator==(const Voxel& o) const { return pass == o.pass && gain == o.gain; }
  };
  using Tile = std::array<Voxel, kVoxels>;
  class Surroundings;

  static Voxel packed(const Gain& gain);
  static Gain unpacked(const Voxel& voxel);
  static std::uint64_t keyOf(int x, int y, int z) {
    return std::uint64_t{static_cast<std::uint32_t>(x)} << 32 |
           std::uint64_t{static_cast<std::uint32_t>(y)} << 16 | static_cast<std::uint32_t>(z);
  }
  Tile read(const octomap::OcTreeKey& low);
  Voxel voxelOf(const semantic_octree::SemanticOcTreeNode& leaf);
  void put(std::uint64_t key, const Tile& tile);
  std::int32_t numberOfSame(const Tile& tile);
  std::int32_t unusedPlace();
  const Tile* find(int x, int y, int z) const;

  semantic_octree::SemanticOcTree& m_map;
  const Question& m_question;
  BeamModel m_model;
  semantic_octree::ClassFilter<float> m_filter;
  semantic_octree::MapFollower m_follower;
  std::unordered_map<float, Voxel> m_uniform;  ///< by log-odds: voxels without a class record
  /** Where a tile is: in m_stored, or (~place) in m_same. */
  std::unordered_map<std::uint64_t, std::int32_t> m_tiles;
  std::deque<Tile> m_stored;
  std::vector<std::int32_t> m_unused;  ///< places in m_stored
  std::vector<Tile> m_same;            ///< tiles that are the same throughout
  std::unordered_map<std::uint32_t, std::int32_t> m_sameByVoxel;
  std::vector<float> m_leaves;  ///< of a sweep: P(a beam leaves)
};

}  // namespace view_information
