#pragma once
#include <semantic_octree/InsertionOptions.h>
#include <semantic_octree/store/Cubes.h>
#include <semantic_types/LabeledCloud.h>
#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

namespace semantic_octree {

/** What becomes of a point: where its beam ends, in voxel units of the map (coordinate /
 * resolution). */
struct Beam {
  enum class Kind : std::uint8_t {
    NotFinite,  ///< not used, nor are the next two
    Near,
    Outside,
    Return,
    Clipped  ///< the return lies beyond the maximum range, where this end is
  };
  Kind kind;
  Eigen::Array3d end;  ///< the sensor, if NotFinite or Near

  bool isUsed() const { return kind >= Kind::Return; }
  bool isReturn() const { return kind == Kind::Return; }
};

/** Beams that a thread looks at at a time: their ends stay near the processor. Rays of one ring are
 * long where those of another are short, so that halves of a scan would not take equally long. */
constexpr std::size_t kBeamsAtATime = 2048;

/** A scan's beams in the map's frame. */
class ScanBeams {
 public:
  /** Replaces them, and keeps the buffer.
   * \throw std::out_of_range the sensor lies outside the map. */
  void set(const semantic_types::LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor,
           double resolution, const InsertionOptions& options);

  std::size_t size() const { return m_beams.size(); }
  /** The sensor, voxel units. */
  const Eigen::Array3d& origin() const { return m_origin; }
  const Beam& beam(std::size_t point) const { return m_beams[point]; }

  /** Box of voxels that the beams cross, inclusive. */
  const VoxelIndex& lowest() const { return m_lowest; }
  const VoxelIndex& highest() const { return m_highest; }
  /** How many points became what. */
  const InsertionReport& report() const { return m_report; }

  static VoxelIndex voxelOf(const Eigen::Array3d& u) {
    return {floorOf(u.x()), floorOf(u.y()), floorOf(u.z())};
  }
  static bool insideMap(const Eigen::Array3d& u) {
    return (u >= -kKeyOfOrigin).all() && (u < kKeyOfOrigin).all();
  }

 private:
  Eigen::Array3d m_origin;
  std::vector<Beam> m_beams;
  VoxelIndex m_lowest, m_highest;
  InsertionReport m_report;
};

/** One bit per voxel of a box of space, in tiles of 8 x 8 x 8 voxels. Inside a tile the bits are in
 * Morton order (x lowest): a 64-bit word is a 4 x 4 x 4 block, a byte the eight children of a node.
 * 4 x 4 x 4 tiles fill a page of memory, so that few pages are touched and a ray's neighbors share
 * them. Rows and layers of pages are padded to powers of two: each coordinate of a voxel has bits
 * of its own in the position of the voxel's bit. */
class ScanGrid {
 public:
  static constexpr int kWords = 8;  ///< per tile

  /** Covers the box of voxels [lowest, highest], and one voxel more on each side. All bits are 0
   * (the user of a bit clears it). \param maxTiles more are refused
   * \throw std::length_error the box is too large. */
  void cover(const VoxelIndex& lowest, const VoxelIndex& highest, std::size_t maxTiles);
  /** Covers the same box as another grid. */
  void coverLike(const ScanGrid& o);

  /** Bits of a position that belong to one coordinate. */
  struct Field {
    std::int64_t mask;
    /** What to add to the coordinate's part, which is then masked, to get the next or the previous
     * voxel's: carries run through the bits between. */
    std::int64_t up() const { return -mask; }
    std::int64_t down() const { return -(mask & -mask); }
  };
  const Field& field(int axis) const { return m_fields[axis]; }

  const VoxelIndex& firstVoxel() const { return m_firstVoxel; }
  /** First tile, in tiles (voxel / 8) of the map whose lowest voxel is 0 (OctoMap's keys). */
  const VoxelIndex& firstTile() const { return m_firstTile; }
  const VoxelIndex& numTiles() const { return m_numTiles; }
  std::size_t numTilesInAll() const { return numberOf(m_numTiles - 1) + 1; }
  /** Number of a tile: x first, then y and z, none left out. \param tile relative to the first */
  std::size_t numberOf(const VoxelIndex& tile) const {
    return (std::size_t(tile.z()) * m_numTiles.y() + tile.y()) * m_numTiles.x() + tile.x();
  }
  /** Calls f(tile, number) for every tile. */
  template <typename F>
  void forEachTile(const F& f) const {
    std::size_t number = 0;
    VoxelIndex tile;
    for (tile.z() = 0; tile.z() < m_numTiles.z(); ++tile.z())
      for (tile.y() = 0; tile.y() < m_numTiles.y(); ++tile.y())
        for (tile.x() = 0; tile.x() < m_numTiles.x(); ++tile.x()) f(tile, number++);
  }
  std::uint64_t* words(const VoxelIndex& tile) { return m_words + bitOf(tile * 8) / 64; }
  const std::uint64_t* words(const VoxelIndex& tile) const {
    return m_words + bitOf(tile * 8) / 64;
  }

  /** Position of a bit = sum of three table entries at the voxel's coordinates relative to the
   * grid. */
  const std::uint64_t* offsets(int axis) const { return m_offsets[axis].data(); }
  /** What to subtract from voxel units of the map to get coordinates relative to the grid. */
  Eigen::Array3d origin() const { return m_firstVoxel.cast<double>(); }

  std::uint64_t bitOf(const VoxelIndex& relative) const {
    return m_offsets[0][relative.x()] + m_offsets[1][relative.y()] + m_offsets[2][relative.z()];
  }
  /** Where a voxel is: the number of its tile, and its bit in there. */
  struct Place {
    std::size_t tile;
    unsigned bit;
  };
  Place placeOf(const VoxelIndex& relative) const {
    const VoxelIndex tile(relative.x() >> 3, relative.y() >> 3, relative.z() >> 3);
    return {numberOf(tile), static_cast<unsigned>(bitOf(relative) & 511)};
  }
  std::uint64_t* words() { return m_words; }
  /** Reserved; pages that no ray touched cost nothing. */
  std::size_t bytes() const { return m_capacity * kBytesPerPage; }
  static constexpr std::size_t kBytesPerPage = 4096;

 private:
  struct Free {
    void operator()(std::byte* p) const { std::free(p); }
  };
  void reserve();

  VoxelIndex m_firstVoxel, m_firstTile, m_numTiles;
  std::array<Field, 3> m_fields{};
  std::size_t m_numPages = 0, m_capacity = 0;  ///< with padding
  std::unique_ptr<std::byte[], Free> m_memory;
  std::uint64_t* m_words = nullptr;  ///< where the first page begins
  std::vector<std::uint64_t> m_offsets[3];
};

/** Bits set in some words. */
unsigned countBits(const std::uint64_t* words, int numWords);

/** Sets the bits of the voxels that rays from one point pass, with the first and without the last
 * (Amanatides, Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing").
 * \param begin, ends voxel units relative to the grid, inside it */
void markRays(ScanGrid& grid, const Eigen::Array3d& begin, const Eigen::Array3d* ends,
              std::size_t numRays);

}  // namespace semantic_octree
