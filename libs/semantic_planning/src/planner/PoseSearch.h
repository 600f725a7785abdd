#pragma once
#include <semantic_planning/roadmap/CollisionChecker.h>
#include <semantic_planning/vehicle/PathPoint.h>

#include <array>
#include <cstdint>
#include <optional>
#include <queue>
#include <unordered_map>
#include <vector>

#include "ClassPrices.h"
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

/** Looks from pose to pose for the cheapest way to one of some targets, in so many poses at most:
 * best first over short arcs and straights in both gears, of which those between poses that are
 * much the same are dropped (as in Dolgov et al., "Path Planning for Autonomous Vehicles in Unknown
 * Semi-structured Environments", 2010), and from these poses to the targets by the vehicle's
 * shortest curves. What a CostField says of the rest of the way tells what is worth going on with.
 */
class PoseSearch {
 public:
  using Length = colored_graph::Length;

  /** A place where the way may end. */
  struct Target {
    GroundPose pose;
    std::optional<CurveState> state;  ///< how it goes on from there; none: not at all
    Length rest;                      ///< what it costs from there on
    std::size_t number;               ///< of the caller
  };
  struct Task {
    GroundPose start;
    double radius;            ///< of the square around the start that is looked at, meters
    double reach;             ///< farthest target that a curve is tried to, meters
    double longestCurve;      ///< of those that are tried, meters
    double weight = 1;        ///< of what the field says: more finds a way sooner, and a worse one
    int poses;                ///< to go on from, at most
    int posesAfter;           ///< the same, once a way was found that is hardly dearer than it must
    int shareOfTargets;       ///< from each pose one of so many is tried
    bool isReversed = false;  ///< the way is one that is driven from its end to its begin
  };
  /** The best way that was found. */
  struct Way {
    std::vector<PathPoint> path;
    std::size_t target;  ///< its number
  };

  /** \param prices, checker must outlive the search */
  PoseSearch(const Task& task, const CollisionChecker& checker, const ClassPrices& prices);

  void add(const Target& target) { m_targets.push_back(target); }
  /** Tells the field what the rest of a way costs from a place on. */
  void addRest(const GroundPose& pose, Length rest) { m_field.add(pose, rest); }

  /** What a way of this cost costs more than any other could. */
  Length excess(Length cost);
  /** Nothing if no way costs less than `most`, or none was found. */
  std::optional<Way> run(Length most);

 private:
  /** A pose that was reached. */
  struct Node {
    GroundPose pose;
    Length cost;
    int before;             ///< -1: it is the first
    ReedsSheppCurve curve;  ///< from there
    CurveState state() const { return endOf(curve); }
  };
  struct Entry {
    Length estimate;
    int node;
    bool operator<(const Entry& o) const {  // the least on top
      return estimate != o.estimate ? o.estimate < estimate : o.node < node;
    }
  };
  /** The best way that is known. */
  struct Joint {
    int node;
    ReedsSheppCurve curve;
    std::size_t target;
  };

  Length ofWay(double length, bool forward) const;
  Length ofChange(const Node& from, const CurveState& to) const;
  const Node& node(int i) const { return m_nodes[static_cast<std::size_t>(i)]; }
  void reach(const Node& node, Length rest);
  void goOn(int from);
  void step(int from, double turn, bool forward);
  void join(int from);
  void join(int from, const Target& target);
  std::vector<ReedsSheppCurve> curves(const GroundPose& from, const GroundPose& to) const;
  /** With its classes, if it is free and costs less than what is known. */
  std::optional<Length> costOver(const ReedsSheppCurve& curve, int from, int to, Length cost,
                                 Length rest);
  std::vector<PathPoint> joined() const;

  const Task m_task;
  const CollisionChecker& m_checker;
  const ClassPrices& m_prices;
  const double m_step;
  CostField m_field;
  std::vector<Target> m_targets;
  ClassBudget m_budget;
  Length m_most = 0, m_good = 0;
  std::vector<Node> m_nodes;
  std::unordered_map<std::uint64_t, Length> m_least;  ///< by what makes poses the same
  std::priority_queue<Entry> m_queue;
  std::optional<Joint> m_joint;
  int m_left;
};

/** A way from one pose to the other, if one is found in a few thousand poses: from the start on, or
 * else from the goal, for a vehicle gets out of a narrow place sooner than into it. */
std::vector<PathPoint> wayBetween(const GroundPose& start, const GroundPose& goal,
                                  const CollisionChecker& checker, const ClassPrices& prices);

/** A path of lower price that begins, or ends, in another way; looked for if what the path costs
 * more than it might is more than it takes to turn around. */
std::optional<std::vector<PathPoint>> withBetterBegin(const std::vector<PathPoint>& path,
                                                      const CollisionChecker& checker,
                                                      const ClassPrices& prices);
std::optional<std::vector<PathPoint>> withBetterEnd(const std::vector<PathPoint>& path,
                                                    const CollisionChecker& checker,
                                                    const ClassPrices& prices);

}  // namespace semantic_planning
