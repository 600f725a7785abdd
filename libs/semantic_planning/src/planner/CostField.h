#pragma once
#include <semantic_planning/roadmap/CollisionChecker.h>

#include <array>
#include <vector>

#include "ClassPrices.h"
#include "MonotoneQueue.h"
#include "RelaxedField.h"

namespace semantic_planning {

/** The least that the rest of a way may cost from the ground around a place on, for a vehicle that
 * could turn on the spot and fits everywhere: classes under its wheels and length count. What
 * nobody asks for is not found out. */
class CostField {
 public:
  using Length = colored_graph::Length;
  static constexpr Length kUnreached = RelaxedField::kUnreached;

  /** \param radius meters; the field is a square \param checker, prices must outlive the field */
  CostField(const GroundPose& center, double radius, const CollisionChecker& checker,
            const ClassPrices& prices);

  /** A place from which the rest costs so much. */
  void add(const GroundPose& pose, Length cost);
  /** What costs more does not matter. */
  void limit(Length most) { m_most = most; }
  /** kUnreached: outside, or there is no way. What is not less than the limit may be too much. */
  Length at(const GroundPose& pose);

 private:
  using Place = RelaxedField::Place;

  bool contains(Column c) const;
  Place placeAt(const GroundPose& pose) const;
  void reach(const Place& place, Length cost);
  void leave(const Place& place, Length cost);
  /** What a step to a place costs, in one of four directions or back. */
  Length ofStep(const Place& to, std::size_t direction) const;

  const CollisionChecker& m_checker;
  const ClassPrices& m_prices;
  std::array<std::vector<Column>, 4> m_wheels;  ///< where they are, by direction
  const Column m_center;
  const int m_reach;  ///< columns to each side of it
  Length m_most = kUnreached;
  RelaxedField m_field;
  MonotoneQueue<RelaxedField::Cell> m_queue;
};

}  // namespace semantic_planning
