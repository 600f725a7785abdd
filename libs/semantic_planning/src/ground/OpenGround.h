#pragma once
#include <semantic_planning/ground/Ground.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace semantic_planning {

/** Where a vehicle is free at any heading, and its wheels are over one class. There its discs and
 * wheels need no look one by one. Found tile by tile when it is asked for, and kept: for as long as
 * the ground stays as it is. */
class OpenGround {
 public:
  /** By how many columns an origin is away, along x or y, from the nearest one where that does not
   * hold; at most kFarthest, 0: here. Where it does there is one surface in each column. */
  struct Room {
    std::uint8_t ofDiscs = 0, ofClass = 0;
  };
  /** Columns from the vehicle's origin that its discs or wheels come to, and by how many voxels
   * ground may be higher or lower there. */
  struct Reach {
    int columns, tolerance;
  };

  /** \param wheels reach no farther than the discs \param needed2 what the surfaces below discs
   * need (Surface::clearance2) */
  OpenGround(const Ground& ground, const Reach& discs, const Reach& wheels, int needed2);

  Room around(Column c);

 private:
  static constexpr int kFarthest = 8;
  using Rooms = std::array<Room, kTileColumns>;

  class Square;
  void read(Column tile, int margin, Square& z, Square& classes, Square& fits) const;
  Rooms find(Column tile) const;
  static Rooms roomsIn(Square free, Square uniform, int margin);

  const Ground& m_ground;
  const Reach m_discs, m_wheels;
  const int m_needed2;
  std::vector<std::unique_ptr<Rooms>> m_tiles;  ///< by number; null: not found yet
};

}  // namespace semantic_planning
