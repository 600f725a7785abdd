#pragma once
#include <semantic_planning/vehicle/PathPoint.h>

#include <cstdint>
#include <optional>
#include <queue>
#include <unordered_map>
#include <vector>

#include "CostField.h"

namespace semantic_planning {

/** Looks near a path's first point for a cheaper way to turn around that leads to the path some
 * meters on: best first over short arcs and straights in both gears, of
 * which those between poses that are much the same are dropped (as in Dolgov et al., "Path Planning
 * for Autonomous Vehicles in Unknown Semi-structured Environments", 2010), and from these poses by
 * the vehicle's shortest curves. The rest of the path, and what a CostField says of the way there,
 * tell what is worth going on with. */
class TurnSearch {
 public:
  using Length = colored_graph::Length;

  /** \param isReversed whether the path is one that is driven from its end to its begin
   * \param prices must outlive the search, as path and checker must */
  TurnSearch(const std::vector<PathPoint>& path, bool isReversed, const CollisionChecker& checker,
             const ClassPrices& prices);

  /** What the path costs more than any other could. */
  Length excess();

  /** The path with another begin that costs less by more than `gain`; nothing if there is none, or
   * after many poses. */
  std::optional<std::vector<PathPoint>> run(Length gain);

 private:
  /** A pose that was reached. */
  struct Node {
    GroundPose pose;
    Length cost;
    int before;             ///< -1: it is the first
    ReedsSheppCurve curve;  ///< from there
    CurveState state() const { return endOf(curve); }
  };
  /** A place of the path. */
  struct Target {
    std::size_t point;
    GroundPose pose;
    CurveState state;  ///< from there on
  };
  struct Entry {
    Length estimate;
    int node;
    bool operator<(const Entry& o) const {  // the least on top
      return estimate != o.estimate ? o.estimate < estimate : o.node < node;
    }
  };
  /** The best way to the path that is known. */
  struct Joint {
    int node;
    ReedsSheppCurve curve;
    std::size_t point;
  };

  GroundPose poseAt(std::size_t point) const;
  CurveState stateAt(std::size_t point) const;
  void sumUp();
  void aim();
  Length most() const { return m_best - m_gain; }
  Length ofWay(double length, bool forward) const;
  Length ofChange(const Node& from, const CurveState& to) const;
  const Node& node(int i) const { return m_nodes[static_cast<std::size_t>(i)]; }
  void reach(const Node& node, Length rest);
  void goOn(int from);
  void step(int from, double turn, bool forward);
  void join(int from);
  void join(int from, const Target& target);
  std::vector<ReedsSheppCurve> curves(const GroundPose& from, const GroundPose& to) const;
  /** With its classes, if it is free and costs less than most(). */
  std::optional<Length> costOver(const ReedsSheppCurve& curve, int from, int to, Length cost,
                                 Length rest);
  std::vector<PathPoint> joined() const;

  const std::vector<PathPoint>& m_path;
  const bool m_isReversed;
  const CollisionChecker& m_checker;
  const ClassPrices& m_prices;
  const double m_radius, m_step;
  CostField m_field;
  std::vector<Length> m_toGo;  ///< from each point on
  std::vector<Target> m_targets;
  ClassBudget m_budget;
  Length m_best = 0, m_gain = 0;
  std::vector<Node> m_nodes;
  std::unordered_map<std::uint64_t, Length> m_least;  ///< by what makes poses the same
  std::priority_queue<Entry> m_queue;
  std::optional<Joint> m_joint;
  int m_left = 500;  ///< poses to go on from
};

/** A path of lower price that begins, or ends, in another way; found by a TurnSearch, if what the
 * path costs more than it might is more than it takes to turn around. */
std::optional<std::vector<PathPoint>> withBetterBegin(const std::vector<PathPoint>& path,
                                                      const CollisionChecker& checker,
                                                      const ClassPrices& prices);
std::optional<std::vector<PathPoint>> withBetterEnd(const std::vector<PathPoint>& path,
                                                    const CollisionChecker& checker,
                                                    const ClassPrices& prices);

}  // namespace semantic_planning
