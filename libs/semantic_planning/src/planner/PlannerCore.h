#pragma once
#include <semantic_octree/MapFollower.h>
#include <semantic_planning/planner/SemanticPlanner.h>

#include <exception>
#include <memory>
#include <optional>

#include "ClassPrices.h"
#include "KeptPath.h"
#include "RelaxedField.h"
#include "roadmap/MapRoadmap.h"

namespace semantic_planning {

/** Whether paths are those of a roadmap: their costs are vectors, which no price can stand for. */
inline bool needsRoadmap(const PlannerOptions& options) {
  return !options.shorten || options.edges != colored_graph::EdgeModel::Profile ||
         options.cost != colored_graph::CostKind::ArcLength;
}

/** Whether one may be made. */
inline bool mayNeedRoadmap(const PlannerOptions& options) {
  return needsRoadmap(options) || options.strict;
}

/** What SemanticPlanner is made of. */
class PlannerCore {
 public:
  struct Place {
    mrpt::math::TPose2D pose;
    std::optional<double> z;
  };

  PlannerCore(semantic_octree::SemanticOcTree& map, const colored_graph::ClassOrder& order,
              const PlannerOptions& options);
  ~PlannerCore();

  /** \throw std::invalid_argument saying what has a number that is not finite */
  static void checkFinite(const char* what, const Place& place);
  PlanResult plan(const Place& start, const Place& goal);
  UpdateResult update();
  PlanResult replan(const Place& start);
  /** As plan() or, without a goal, replan(), in slices. */
  void begin(const Place& start, const std::optional<Place>& goal);
  std::optional<PlanResult> goOn(std::size_t& work);
  void forget();
  PlanStatus check(const Place& place) const;

  const PlannerOptions& options() const { return m_options; }
  const colored_graph::ClassOrder& order() const { return m_checker.order(); }
  const Ground& ground() const;
  bool hasPlanned() const { return m_hasPlanned; }
  bool hasRoadmap() const { return m_roadmap != nullptr; }
  const Roadmap& roadmap() const;

 private:
  using VertexId = colored_graph::VertexId;

  /** From the first thing that a call changes to its end. If it is left by an exception, ground,
   * roadmap and search do not belong together: the planner is broken from then on. */
  class Change {
   public:
    explicit Change(PlannerCore& core) : m_broken(core.m_broken) { core.checkWhole(); }
    ~Change() { m_broken = std::uncaught_exceptions() > m_exceptions; }
    Change(const Change&) = delete;
    Change& operator=(const Change&) = delete;

   private:
    bool& m_broken;
    const int m_exceptions = std::uncaught_exceptions();
  };
  void checkWhole() const;

  /** What the roadmap has to follow. */
  struct MapChange {
    std::size_t tilesTouched = 0;
    std::vector<Column> tiles;  ///< of the ground
  };
  MapChange followMap(StageClock& clock);
  /** The vehicle stands at the start: where the map knows no ground below it, there is some. */
  void standAt(const Place& start);
  PlanStatus placed(const Place& place, std::optional<GroundPose>& pose) const;
  /** Status, reason and obstacle if a vehicle cannot stand there. \param what "start" or "goal" */
  bool isRefused(const char* what, const Place& place, std::optional<GroundPose>& pose,
                 PlanResult& result) const;
  /** Refuses if nothing can be planned between these places. */
  bool refuse(const Place& start, const Place& goal, PlanResult& result);
  colored_graph::SearchOptions searchOptions(const Roadmap& map);
  const CollisionChecker& checkerOfSearch();
  void makeRoadmap();
  /** Puts start and goal where they are now. */
  void moveEnds(Roadmap& map);
  bool isCancelled() const { return m_options.cancelled && m_options.cancelled(); }
  struct Task {
    CollisionChecker checker;  ///< of this search
    GroundPose start, goal;
    std::optional<PlanResult> rest;  ///< of the path that is kept
  };
  struct Solution {
    PlanResult plan;
    /** The way of a vehicle that turns on the spot, meters; none: what is kept stays as it is. */
    std::optional<double> least;
  };
  struct Sliced;
  void checkReplan(const Place& start) const;
  void abandon();
  /** \return a result that is known without a search */
  std::optional<PlanResult> prepare(const Place& start, const Place& goal, StageClock& clock);
  std::optional<PlanResult> prepareAgain(const Place& start, std::optional<PlanResult>& rest);
  PlanResult pathBy(const RelaxedPath& relaxed, const Task& task, StageClock& clock);
  Solution solve(const Task& task, StageClock& clock);
  PlanResult take(Solution solution, StageClock& clock);
  PlanResult searchRoadmap(StageClock& clock);
  PlanResult noPath(const RelaxedPath& relaxed, const Task& task) const;

  semantic_octree::SemanticOcTree& m_map;
  semantic_octree::MapFollower m_follower;  ///< of what the ground has not read
  const PlannerOptions m_options;
  Ground m_ground;
  CollisionChecker m_checker;
  std::optional<CollisionChecker> m_checkerOfSearch;  ///< none since the ground changed
  const ClassPrices m_prices;
  KeptPath m_kept;
  colored_graph::CostModel m_model;
  std::unique_ptr<MapRoadmap> m_roadmap;
  std::optional<GroundPose> m_startPose, m_goalPose;
  Place m_goalPlace;
  VertexId m_start = colored_graph::kNoVertex, m_goal = colored_graph::kNoVertex;
  std::unique_ptr<colored_graph::GraphSearch> m_search;  ///< of the roadmap's graph
  bool m_hasPlanned = false, m_broken = false;
  double m_evaluating = 0;            ///< milliseconds of the present search
  std::optional<PlanResult> m_known;  ///< what was begun, if it needs no slices
  std::unique_ptr<Sliced> m_sliced;
};

}  // namespace semantic_planning
