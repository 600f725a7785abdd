#pragma once
#include <semantic_planning/roadmap/CollisionChecker.h>
#include <semantic_planning/vehicle/MotionCost.h>

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "ClassPrices.h"

namespace semantic_planning {

/** Poses, of which a path takes one or none. */
using Station = std::vector<GroundPose>;

/** A curve of a path. */
struct Leg {
  ReedsSheppCurve curve;
  int from, to;  ///< keys of the surfaces at its ends
  colored_graph::EdgeProfile profile;
};

/** Finds the path of least price from the first of some stations to the last, by dynamic
 * programming: the best way to each pose, once for each gear in which it is arrived at. A curve
 * between poses of one class is not looked at where it would not pay if all of it were of that
 * class. The first pose of each station, and those of the first and the last one, are connected
 * with all others, the rest only with poses that head about the same way along the line between
 * them. */
class LatticeSearch {
 public:
  /** \param span a curve goes on by so many stations at most \param prices, checker must outlive
   * the search */
  LatticeSearch(const std::vector<Station>& stations, const CollisionChecker& checker,
                const ClassPrices& prices, std::size_t span);

  /** Nothing if no way is free. */
  std::optional<std::vector<Leg>> run();

 private:
  using Length = colored_graph::Length;
  static constexpr double kLongest = 15;  ///< curve, meters

  /** The best way that is known to a pose, arriving in one gear: its last curve. */
  struct Label {
    Length cost = 0;
    const Leg* last = nullptr;
    const Label* before = nullptr;
    bool reached = false;
  };
  struct Place {
    GroundPose pose;
    mrpt::math::TPoint2D heading;  ///< unit vector
    bool isFree;                   ///< to connect with poses that head elsewhere
    ClassId classId;
    std::array<Label, 2> labels;  ///< arriving forward, backward

    const Label* best() const;
  };
  /** A place from which a curve may lead on. */
  struct Origin {
    Length bound;
    const Place* place;
    bool operator<(const Origin& o) const { return o.bound < bound; }  // the least on top of a heap
  };

  void arriveAt(Place& to, std::size_t station);
  void addOrigin(const Place& from, const Place& to);
  /** Ways that arrive in this gear are of use if they cost less. */
  Length limit(const Place& to, bool forward) const;
  void connect(const Place& from, Place& to);
  void connect(const Place& from, Place& to, const ReedsSheppCurve& curve);
  /** The least cost up to where a curve has been driven, its classes left out. */
  std::pair<const Label*, Length> leastBefore(const Place& from,
                                              const ReedsSheppCurve& curve) const;

  const CollisionChecker& m_checker;
  const MotionCost& m_cost;
  const ClassPrices& m_prices;
  const std::size_t m_span;
  const Length m_gearChange;
  std::vector<std::vector<Place>> m_places;
  std::deque<Leg> m_legs;
  std::vector<Origin> m_origins;  ///< of the place that is arrived at
  ClassBudget m_budget;
};

}  // namespace semantic_planning
