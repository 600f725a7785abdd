#pragma once
#include <semantic_planning/roadmap/EdgeChecker.h>
#include <semantic_planning/vehicle/DrivePrice.h>

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "WayPricing.h"

namespace semantic_planning {

/** Poses, of which a path takes one or none. */
using Station = std::vector<GroundPose>;

/** A curve of a path. */
struct Leg {
  ReedsSheppCurve curve;
  int from, to;  ///< keys of the surfaces at its ends
  colored_graph::EdgeProfile profile;
};

/** Finds paths of least cost from the first of some stations to the last, by dynamic programming:
 * the best way to each pose, once for each gear in which it is arrived at. What was found about
 * curves is kept for other costs. A curve between poses of one class is not looked at where it
 * would not pay if all of it were of that class. The first pose of each station, and those of the
 * first and the last one, are connected with all others, the rest only with poses that head about
 * the same way along the line between them. */
class StationSearch {
 public:
  /** \param span a curve goes on by so many stations at most \param reach and is so long at most,
   * meters */
  StationSearch(const std::vector<Station>& stations, const EdgeChecker& checker, std::size_t span,
                double reach);

  /** Nothing if no way is free. */
  std::optional<std::vector<Leg>> run(const WayPricing& pricing);

 private:
  using Length = colored_graph::Length;
  struct Connection;
  /** Of m_connections. */
  struct Span {
    std::uint32_t first = 0, count = 0;
    bool isKnown = false;
  };
  /** The best way that is known to a pose, arriving in one gear. */
  struct Label {
    Length cost = 0;
    const Connection* last = nullptr;
    const Label* before = nullptr;
    bool reached = false;
  };
  struct Place {
    GroundPose pose;
    mrpt::math::TPoint2D heading;  ///< unit vector
    bool isFree;                   ///< to connect with poses that head elsewhere
    ClassId classId;
    std::size_t number, firstOrigin;  ///< among the places of all stations
    std::vector<Span> connections;    ///< from each place from `firstOrigin` on, those to here
    std::array<Label, 2> labels;      ///< arriving forward, backward

    const Label* best() const;
  };
  /** A curve between two places. */
  struct Connection {
    ReedsSheppCurve curve;
    int from, to;  ///< keys of the surfaces
    Length price;
    enum { New, Costly, Known } state = New;  ///< costly: too much so, in one run at least
    std::optional<colored_graph::EdgeProfile> profile;  ///< if known; none: it cannot be driven
    colored_graph::EdgeProfile seen{};                  ///< if costly: the part that was looked at
  };
  /** A place from which a curve may lead on. */
  struct Origin {
    Length bound;
    const Place* place;
    bool operator<(const Origin& o) const { return o.bound < bound; }  // the least on top of a heap
  };

  void arriveAt(Place& to, std::size_t station, const WayPricing& pricing);
  void addOrigin(const Place& from, const Place& to, const WayPricing& pricing);
  /** Ways that arrive in this gear are of use if they cost less. */
  Length limit(const Place& to, bool forward) const;
  void connect(const Place& from, Place& to, const WayPricing& pricing);
  Span connections(const Place& from, Place& to);
  /** Looks at a curve until its classes cost more than `most`, or not at all where those of the
   * part that is known do. */
  void evaluate(Connection& connection, Length most, const WayPricing& pricing);
  /** The least cost up to where a connection's curve has been driven, its classes left out. */
  std::pair<const Label*, Length> leastBefore(const Place& from,
                                              const Connection& connection) const;

  const EdgeChecker& m_checker;
  const DrivePrice& m_price;
  const std::size_t m_span;
  const double m_reach;
  const Length m_gearChange;
  std::vector<std::vector<Place>> m_places;
  std::deque<Connection> m_connections;
  std::vector<Origin> m_origins;  ///< of the place that is arrived at
  ClassBudget m_budget;           ///< of the present run
};

}  // namespace semantic_planning
