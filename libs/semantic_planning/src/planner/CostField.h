#pragma once
#include <semantic_planning/roadmap/CollisionChecker.h>

#include <array>
#include <limits>
#include <queue>
#include <vector>

#include "ClassPrices.h"

namespace semantic_planning {

/** The least that the rest of a way may cost from the columns around a place on, for a vehicle that
 * could turn on the spot and fits everywhere: classes under its wheels and length count. One
 * surface of each column is known, the first one that is reached. */
class CostField {
 public:
  using Length = colored_graph::Length;
  static constexpr Length kUnreached = std::numeric_limits<Length>::max();

  /** \param radius meters; the field is a square \param checker, prices must outlive the field */
  CostField(const GroundPose& center, double radius, const CollisionChecker& checker,
            const ClassPrices& prices);

  /** A place from which the rest costs so much. */
  void add(const GroundPose& pose, Length cost);
  /** Until all is known that costs less. \param until enough if its cost is known; may be null */
  void spread(Length most, const GroundPose* until);
  /** kUnreached: more than what was asked for, or outside. */
  Length at(const GroundPose& pose) const;

 private:
  struct Cell {
    Length cost = kUnreached;
    bool done = false;
  };
  struct Entry {
    Length cost;
    int index, z;
    bool operator<(const Entry& o) const { return o.cost < cost; }  // the least on top
  };

  /** -1: outside. */
  int indexOf(Column c) const;
  int indexOf(const GroundPose& pose) const {
    return indexOf(m_checker.ground().columnAt(pose.pose.x, pose.pose.y));
  }
  void leave(const Entry& entry);
  /** What a step to a column costs, in one of four directions or back. */
  Length ofStep(Column to, int z, std::size_t direction) const;

  const CollisionChecker& m_checker;
  const ClassPrices& m_prices;
  std::array<std::vector<Column>, 4> m_wheels;  ///< where they are, by direction
  Column m_low;
  int m_edge;  ///< columns
  std::vector<Cell> m_cells;
  std::priority_queue<Entry> m_queue;
};

}  // namespace semantic_planning
