#pragma once
#include <semantic_octree/MapFollower.h>
#include <semantic_octree/SemanticOcTree.h>
#include <view_information/UnknownPrior.h>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>
#include <vector>

namespace view_information {

/** What a sensor sees from a place, whatever its heading: between two elevations. */
struct ViewShape {
  double range = 10;                  ///< meters
  double lowest = -45, highest = 15;  ///< elevations, degrees
  double width = 80;  ///< field of view around the heading, degrees; 360: all around
  /** A LiDAR's beams above each other, and all around; 0: no voxel lies between beams. */
  int rings = 0, columns = 0;
};

/** The voxels of a ViewShape in all headings. Each is seen through the last one before it that is
 * in the next smaller shell; the first is the sensor's. */
class ViewTemplate {
 public:
  static constexpr int kHeadings = 36;

  /** \param voxelSize meters \throw std::invalid_argument naming what is out of range */
  ViewTemplate(const ViewShape& shape, double voxelSize);

  const ViewShape& shape() const { return m_shape; }
  struct Voxel {
    std::int16_t x, y, z;       ///< from the sensor's
    std::uint16_t shell : 10;   ///< the largest difference of these
    std::uint16_t heading : 6;  ///< in which of kHeadings sectors, from -180 degrees on
    std::int32_t next;          ///< behind all that are seen through it, which follow it
  };
  const std::vector<Voxel>& voxels() const { return m_voxels; }
  /** For how many voxels of its shell it stands: far ones are not all in the template, and some
   * are in it more than once. */
  float weight(const Voxel& voxel) const { return m_weights[voxel.shell]; }
  /** A voxel is seen by who looks along a sector's middle. */
  bool sees(const Voxel& voxel, int sector) const;
  int reach() const { return m_reach; }    ///< largest difference along an axis
  int lowest() const { return m_lowest; }  ///< difference in z
  int highest() const { return m_highest; }

 private:
  ViewShape m_shape;
  int m_reach = 0, m_lowest = 0, m_highest = 0;
  std::vector<Voxel> m_voxels;
  std::vector<float> m_weights;  ///< by shell
};

/** What is gained by sector of ViewTemplate::kHeadings, nats. */
using SectorGains = std::array<float, ViewTemplate::kHeadings>;
/** What a view gains that looks along a sector's middle. */
double gainOfHeading(const SectorGains& gains, int sector, double width);
/** The heading of a sector's middle, radians. */
double headingOf(int sector);

/** What one more look at each known voxel of a map gains, and how far beams get through it. Tiles
 * of 8 x 8 x 8 voxels follow the map's changes. Half a tile is a byte a voxel and the values in it,
 * or one value: less than four bytes a known voxel. Not thread safe; the map must not change during
 * a call. */
class GainField {
 public:
  /** \param map must outlive this. */
  GainField(semantic_octree::SemanticOcTree& map, const Question& question);

  /** Follows the map. \return what changed since the last call */
  semantic_octree::TileChange update();
  /** Nothing where the map knows nothing. */
  std::optional<Gain> at(const octomap::OcTreeKey& key) const;
  /** What views from a voxel gain: each voxel counts once, as surely as it is reached. */
  SectorGains sweep(const ViewTemplate& view, UnknownPrior& prior,
                    const octomap::OcTreeKey& from) const;
  /** What a view from a voxel along a sector's middle is expected to add to a compressed tree's
   * objective by the question's weights. It is growthOfTree() of the template's voxels, in nats
   * summed over the voxels that each stands for. The prior says which are reached, the map what is
   * believed of them. */
  Bounds growth(const ViewTemplate& view, UnknownPrior& prior, const octomap::OcTreeKey& from,
                int sector) const;

  /** What the map tells: how far it is believed of each occupied voxel that it is something else
   * than of space of which nothing is known, nats. */
  double known() const { return m_known; }

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
  /** Numbers of values, byte by byte, and the values; or one value, if it is the same throughout.
   */
  using Half = std::vector<Voxel>;
  struct Stored {
    std::array<Half, 2> halves;
    float known = 0;  ///< nats
  };
  struct Computed {
    semantic_octree::ClassBelief belief;  ///< of a class record
    float logOdds = std::numeric_limits<float>::quiet_NaN();
    bool hasRecord = false;
    Voxel voxel{};
    float known = 0;  ///< nats
  };
  static constexpr int kOfComputed = 52;  ///< bits of a hash beside the number of a Computed
  struct View;
  class Surroundings;

  static Voxel packed(const Gain& gain);
  static Gain unpacked(const Voxel& voxel);
  static std::uint64_t keyOf(int x, int y, int z) {
    return std::uint64_t{static_cast<std::uint32_t>(x)} << 32 |
           std::uint64_t{static_cast<std::uint32_t>(y)} << 16 | static_cast<std::uint32_t>(z);
  }
  /** visit(voxel of the view, P(reached), its gain) for all that is reached. */
  template <class Visit>
  void lookAround(const ViewTemplate& view, UnknownPrior& prior, const octomap::OcTreeKey& from,
                  Visit visit) const;
  struct Tile {
    std::array<Voxel, kVoxels> voxels;
    float known = 0;  ///< nats
  };
  Stored read(const octomap::OcTreeKey& low);
  void read(const semantic_octree::SemanticOcTreeNode& node, int edge, int at, Tile& tile);
  const Computed& computed(const semantic_octree::SemanticOcTreeNode& leaf);
  static Half stored(const Voxel* voxels);
  /** The half that a voxel is in; null: nothing is known there. */
  const Half* find(int x, int y, int z) const;

  semantic_octree::SemanticOcTree& m_map;
  const Question& m_question;
  BeamModel m_model;
  semantic_octree::ClassFilter m_filter;
  semantic_octree::MapFollower m_follower;
  std::vector<Computed> m_computed;
  std::vector<double> m_nothingKnown;
  double m_known = 0;
  std::unordered_map<std::uint64_t, Stored> m_tiles;
};

}  // namespace view_information
