#pragma once
#include <colored_graph/CostModel.h>
#include <colored_graph/GraphSearch.h>
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_planning/ground/Ground.h>
#include <semantic_planning/planner/PlanResult.h>
#include <semantic_planning/roadmap/Roadmap.h>
#include <semantic_planning/roadmap/RoadmapOptions.h>

#include <functional>
#include <memory>
#include <optional>

namespace semantic_planning {

struct PlannerOptions {
  VehicleOptions vehicle;
  GroundOptions ground;
  RoadmapOptions roadmap;
  // For studies and tests, without a name in files: how a roadmap's paths are judged.
  colored_graph::EdgeModel edges = colored_graph::EdgeModel::Profile;
  colored_graph::CostKind cost = colored_graph::CostKind::ArcLength;
  /** Looks for the path of least price (PlanResult::price) beside the way that a vehicle would take
   * which turns on the spot, without a roadmap unless `strict`. With EdgeModel::Profile and
   * CostKind::ArcLength only; otherwise, and without, a roadmap's best path is the result, classes
   * before length. */
  bool shorten = false;
  /** With `shorten`: classes come before length, whatever the order's rates (ClassOrder). */
  bool strict = false;
  /** Asked often during a search, which stops when it answers true. */
  std::function<bool()> cancelled;
  /** Makes a planner's search of the roadmap's graph; none: COA* (colored_graph::GraphSearch). */
  std::function<std::unique_ptr<colored_graph::GraphSearch>()> graphSearch;

  /** Describes all but the vehicle, which has a file of its own (loadVehicle). */
  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

class PlannerCore;

/** Plans paths of a vehicle over a semantic map, by what driving and each class cost.
 *
 *     SemanticPlanner planner(map, loadClassOrder("order.yaml", map.classes()), options);
 *     PlanResult plan = planner.plan(start, goal);
 *     while (plan.found() && !arrived()) {
 *       map.insert(...);             // what was seen meanwhile
 *       planner.update();            // ground and roadmap follow the map
 *       plan = planner.replan(pose());
 *     }
 *
 * A plan to another goal makes a roadmap of its own. Answers are those of a new planner. One that
 * runs out of memory, or whose `cancelled` throws, is broken: all further calls throw
 * std::logic_error. Not thread safe. While a call reads the map, another thread that changes it
 * gets std::logic_error, and the other way round (ReadLock). A map may have any number of planners,
 * and other readers of its changes (MapFollower). */
class SemanticPlanner {
 public:
  /** \param map must outlive the planner. With a roadmap of the tree (isOfTree) it has to keep
   * G-values (setAbstraction()). \param order over the map's class ids, 0 = unknown
   * ground (loadClassOrder)
   * \throw std::invalid_argument bad options, or an order of other classes
   * \throw std::logic_error the map keeps no G-values and the roadmap needs them. */
  SemanticPlanner(semantic_octree::SemanticOcTree& map, const colored_graph::ClassOrder& order,
                  const PlannerOptions& options = {});
  ~SemanticPlanner();
  SemanticPlanner(SemanticPlanner&&) noexcept;

  /** Plans from scratch, over the map as it is now. Heights (meters) tell which of several levels
   * is meant; without, the lowest drivable one. \throw std::invalid_argument a number is not
   * finite. */
  PlanResult plan(const mrpt::math::TPose2D& start, const mrpt::math::TPose2D& goal,
                  std::optional<double> startZ = {}, std::optional<double> goalZ = {});

  /** Brings ground and roadmap up to date with the map. Leaves of the compressed tree that came or
   * went change vertices; edges over changed ground are looked at again. */
  UpdateResult update();

  /** The best path now, from where the vehicle is, to the same goal. What it has of a path is kept
   * if it is free and nothing costs 0.5 m less. A roadmap's search is repaired. \throw
   * std::logic_error nothing was planned before. */
  PlanResult replan(const mrpt::math::TPose2D& start, std::optional<double> startZ = {});

  /** plan(), and replan() without a goal, in slices: for those who have other things to do
   * meanwhile, as a vehicle that drives. Between slices map and planner may be updated. The search
   * goes on over the ground as it was, and begins anew if something is on the path that it finds.
   * Where a roadmap is used, all of it is done when it begins. plan(), replan() and forget() give
   * up what was begun. \throw as plan() and replan() */
  void begin(const mrpt::math::TPose2D& start, const std::optional<mrpt::math::TPose2D>& goal,
             std::optional<double> startZ = {}, std::optional<double> goalZ = {});
  /** \param work how much may be done, about as many columns of ground or 0.3 us each on one core
   * of 2020; what is left of it stays there \return nothing: there is more to do.
   * \throw std::logic_error nothing was begun */
  std::optional<PlanResult> goOn(std::size_t& work);

  /** Forgets all that plans before have found out, but for the ground: the next plan() takes as
   * long as the first one. */
  void forget();

  const PlannerOptions& options() const;
  const colored_graph::ClassOrder& order() const;
  const Ground& ground() const;
  /** Whether replan() has something to go on with: false before the first plan, and after one whose
   * start or goal was refused. */
  bool hasPlanned() const;
  /** Whether the last plan needed a roadmap. */
  bool hasRoadmap() const;
  /** The roadmap of the last plan. \throw std::logic_error it had none. */
  const Roadmap& roadmap() const;
  /** Whether the vehicle can stand there: PlanStatus::Found, or what is the matter at a start. */
  PlanStatus check(const mrpt::math::TPose2D& pose, std::optional<double> z = {}) const;

 private:
  const semantic_octree::SemanticOcTree* m_map;
  std::unique_ptr<PlannerCore> m_core;
};

}  // namespace semantic_planning
