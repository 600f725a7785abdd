#include "PlannerCore.h"

#include <semantic_abstraction/Abstraction.h>
#include <semantic_planning/planner/Slices.h>
#include <strict_files/TextFile.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "PathImprovement.h"
#include "Refusal.h"
#include "ground/ColumnGrid.h"
#include "ground/GroundAround.h"

namespace semantic_planning {

using colored_graph::PathResult;

namespace {

PlannerOptions validated(const PlannerOptions& options,
                         const semantic_octree::SemanticOcTree& map) {
  options.validate();
  if (mayNeedRoadmap(options) && isOfTree(options.roadmap.kind) && !hasAbstraction(map))
    throw std::logic_error("SemanticPlanner: the map keeps no G-values (setAbstraction)");
  return options;
}

/** A start's trouble as the goal's. */
PlanStatus atGoal(PlanStatus start) {
  return start == PlanStatus::StartOffGround ? PlanStatus::GoalOffGround
         : start == PlanStatus::StartBlocked ? PlanStatus::GoalBlocked
                                             : PlanStatus::GoalForbidden;
}

/** "(25.1, 3.9), 0.4 m from the goal" */
std::string textOf(const mrpt::math::TPoint2D& place, const mrpt::math::TPose2D& from,
                   const char* what) {
  std::ostringstream text;
  const strict_files::ClassicNumbers classic(text);
  text << std::fixed << std::setprecision(1) << '(' << place.x << ", " << place.y << "), "
       << std::hypot(place.x - from.x, place.y - from.y) << " m from the " << what;
  return text.str();
}

/** "the goal (25, 4) is blocked: (25.1, 3.9), 0.4 m from the goal: ground not known" */
std::string reasonOf(const char* what, PlanStatus status, const mrpt::math::TPose2D& pose,
                     const Refusal& refusal) {
  std::ostringstream reason;
  const strict_files::ClassicNumbers classic(reason);
  const auto rounded = [](double m) { return std::round(100 * m) / 100; };
  reason << "the " << what << " (" << rounded(pose.x) << ", " << rounded(pose.y) << ") is "
         << (status == PlanStatus::StartOffGround ? "off the ground: "
             : status == PlanStatus::StartBlocked ? "blocked: "
                                                  : "on forbidden ground: ");
  if (status != PlanStatus::StartOffGround) reason << textOf(refusal.place, pose, what) << ": ";
  reason << refusal.what;
  return reason.str();
}

}  // namespace

/** A search that goes on while the ground changes. */
struct PlannerCore::Sliced {
  Sliced(PlannerCore& core, std::optional<PlanResult> rest)
      : ground(core.m_ground.frozen()),
        task{CollisionChecker(ground, core.m_options.vehicle, core.order()).forSearch(),
             *core.m_startPose, *core.m_goalPose, std::move(rest)},
        slices([this, &core] { solution = core.solve(task, clock); }) {}

  StageClock clock;
  const Ground ground;
  const Task task;
  std::vector<Column> changed;  ///< tiles of the ground, since it began
  Solution solution;
  Slices slices;
};

PlannerCore::PlannerCore(semantic_octree::SemanticOcTree& map,
                         const colored_graph::ClassOrder& order, const PlannerOptions& options)
    : m_map(map),
      m_follower(map.follow()),
      m_options(validated(options, map)),
      m_ground(map, options.vehicle, options.ground, order),
      m_checker(m_ground, options.vehicle, options.strict ? order.strict() : order),
      m_prices(m_checker.order()),
      m_kept(m_checker, m_prices),
      m_model{order, options.edges, options.cost, true},
      m_search(options.graphSearch ? options.graphSearch()
                                   : std::make_unique<colored_graph::ColoredGraphSearch>()) {
  m_follower.skipTiles();  // the ground began with the whole map
}

void PlannerCore::checkFinite(const char* what, const Place& place) {
  if (!std::isfinite(place.pose.x) || !std::isfinite(place.pose.y) ||
      !std::isfinite(place.pose.phi) || !std::isfinite(place.z.value_or(0)))
    throw std::invalid_argument(std::string(what) + ": x, y, heading or z is not a finite number");
}

void PlannerCore::checkWhole() const {
  if (m_broken)
    throw std::logic_error(
        "SemanticPlanner: it is broken, for a call failed while it changed it; make a new one");
}

const Ground& PlannerCore::ground() const {
  checkWhole();
  return m_ground;
}

const Roadmap& PlannerCore::roadmap() const {
  checkWhole();
  if (!m_roadmap) throw std::logic_error("SemanticPlanner: the last plan had no roadmap");
  return m_roadmap->roadmap();
}

PlanStatus PlannerCore::placed(const Place& place, std::optional<GroundPose>& pose) const {
  pose = m_checker.place(place.pose, place.z);
  if (!pose) return PlanStatus::StartOffGround;
  if (m_checker.fit(*pose) != Fit::Free) return PlanStatus::StartBlocked;
  const bool forbidden = order().rank(m_checker.classAt(*pose)) == colored_graph::kForbidden;
  return forbidden ? PlanStatus::StartForbidden : PlanStatus::Found;
}

PlanStatus PlannerCore::check(const Place& place) const {
  checkWhole();
  checkFinite("pose", place);
  std::optional<GroundPose> pose;
  return placed(place, pose);
}

bool PlannerCore::isRefused(const char* what, const Place& place, std::optional<GroundPose>& pose,
                            PlanResult& result) const {
  result.status = placed(place, pose);
  if (result.status == PlanStatus::Found) return false;
  const Refusal refusal = refusalOf(m_checker, result.status, place.pose, pose);
  result.reason = reasonOf(what, result.status, place.pose, refusal);
  result.obstacle = refusal.place;
  return true;
}

bool PlannerCore::refuse(const Place& start, const Place& goal, PlanResult& result) {
  if (isRefused("start", start, m_startPose, result)) return true;
  if (!isRefused("goal", goal, m_goalPose, result)) return false;
  result.status = atGoal(result.status);
  return true;
}

colored_graph::SearchOptions PlannerCore::searchOptions(const Roadmap& map) {
  colored_graph::SearchOptions search;
  search.lengthBound = [&map](VertexId a, VertexId b) { return map.lengthBound(a, b); };
  search.evaluate = [this, &map](colored_graph::EdgeId e) {
    const auto begin = std::chrono::steady_clock::now();
    auto profile = map.evaluate(e);
    m_evaluating += StageClock::millisecondsSince(begin);
    return profile;
  };
  search.cancelled = m_options.cancelled;
  return search;
}

std::optional<PlanResult> PlannerCore::prepare(const Place& start, const Place& goal,
                                               StageClock& clock) {
  PlanResult result;
  abandon();
  m_search->forget();
  m_roadmap.reset();
  m_kept.drop();
  m_goalPlace = goal;
  followMap(clock);
  standAt(start);
  m_hasPlanned = !refuse(start, goal, result);
  return m_hasPlanned ? std::nullopt : std::optional(result);
}

PlanResult PlannerCore::plan(const Place& start, const Place& goal) {
  StageClock clock;
  checkFinite("start", start);
  checkFinite("goal", goal);
  const Change change(*this);
  if (const auto refused = prepare(start, goal, clock)) return *refused;
  return take(solve({checkerOfSearch(), *m_startPose, *m_goalPose, {}}, clock), clock);
}

void PlannerCore::standAt(const Place& start) {
  const auto assume = [this](const std::vector<GroundPoint>& points) {
    const std::vector<Column> tiles = m_ground.assume(points);
    if (!tiles.empty()) m_checkerOfSearch.reset();
  };
  assume({});
  const PlanStatus status = placed(start, m_startPose);
  if (status != PlanStatus::StartOffGround && status != PlanStatus::StartBlocked) return;
  assume(groundBelow(m_ground, m_options.vehicle, start.pose, start.z));
}

const CollisionChecker& PlannerCore::checkerOfSearch() {
  if (!m_checkerOfSearch) m_checkerOfSearch.emplace(m_checker.forSearch());
  return *m_checkerOfSearch;
}

void PlannerCore::makeRoadmap() {
  m_search->forget();
  const PlanningRegion region(m_ground, m_startPose->pose, m_goalPose->pose,
                              m_options.roadmap.buffer);
  m_roadmap =
      std::make_unique<MapRoadmap>(m_map, m_checker, m_options.roadmap, *m_startPose, region);
  m_start = m_roadmap->roadmap().addQueryVertex(*m_startPose);
  m_goal = m_roadmap->roadmap().addQueryVertex(*m_goalPose);
}

/** From scratch in a new roadmap, otherwise repairing what it found before. */
PlanResult PlannerCore::searchRoadmap(StageClock& clock) {
  const bool isNew = !m_roadmap;
  if (isNew) makeRoadmap();
  Roadmap& map = m_roadmap->roadmap();
  if (!isNew) moveEnds(map);
  clock.end("roadmap");
  m_evaluating = 0;
  const PathResult path =
      isNew ? m_search->search(map.graph(), m_start, m_goal, m_model, searchOptions(map))
            : m_search->replan(map.graph(), m_start, m_goal, m_model, searchOptions(map));
  clock.end("search", "evaluateEdges", m_evaluating);
  PlanResult result;
  describePath(path, map, m_checker, result);
  result.price = priceOf(result, m_checker, m_prices);
  result.numVertices = map.graph().vertexCount();
  result.numEdges = map.graph().edgeCount();
  clock.end("path");
  return result;
}

/** "...; what can be reached ends at (3.1, 2.9), 4.2 m from the goal" */
PlanResult PlannerCore::noPath(const RelaxedPath& relaxed, const Task& task) const {
  PlanResult result;
  result.reason = "from pose to pose no way was found";
  if (!relaxed.nearest) return result;
  const bool overForbidden = !searchRelaxed(task.checker, task.start, task.goal, true).path.empty();
  if (overForbidden) result.status = PlanStatus::OnlyForbidden;
  result.obstacle = relaxed.nearest;
  result.reason = std::string(describe(overForbidden ? colored_graph::SearchStatus::OnlyForbidden
                                                     : colored_graph::SearchStatus::NotConnected)) +
                  "; what can be reached ends at " +
                  textOf(*relaxed.nearest, task.goal.pose, "goal");
  return result;
}

void PlannerCore::forget() {
  const Change change(*this);
  abandon();
  m_search->forget();
  m_roadmap.reset();
  m_kept.drop();
  m_hasPlanned = false;
}

PlannerCore::MapChange PlannerCore::followMap(StageClock& clock) {
  const semantic_octree::TileChange touched = m_follower.tiles();
  MapChange change;
  change.tilesTouched = touched.tiles.size();
  change.tiles = m_ground.update(touched);
  if (!change.tiles.empty()) m_checkerOfSearch.reset();
  clock.end("ground");
  m_kept.groundChanged(change.tiles);
  if (m_sliced)
    m_sliced->changed.insert(m_sliced->changed.end(), change.tiles.begin(), change.tiles.end());
  return change;
}

UpdateResult PlannerCore::update() {
  StageClock clock;
  UpdateResult result;
  const Change whole(*this);
  const MapChange change = followMap(clock);
  result.tilesTouched = change.tilesTouched;
  result.tilesChanged = change.tiles.size();
  if (m_roadmap) m_roadmap->update(change.tiles);
  clock.end("roadmap");
  result.times = clock.take();
  return result;
}

/** A start that stays where it is keeps what the search knows. */
void PlannerCore::moveEnds(Roadmap& map) {
  if (map.pose(m_goal).z != m_goalPose->z) {
    map.removeQueryVertex(m_goal);
    m_goal = map.addQueryVertex(*m_goalPose);
    m_search->forget();
  }
  const GroundPose& present = map.pose(m_start);
  if (present.pose == m_startPose->pose && present.z == m_startPose->z) return;
  const VertexId before = m_start;
  m_start = map.addQueryVertex(*m_startPose);  // first, so that it is another id
  map.removeQueryVertex(before);
}

void PlannerCore::checkReplan(const Place& start) const {
  checkWhole();
  if (!m_hasPlanned) throw std::logic_error("SemanticPlanner: nothing was planned yet");
  checkFinite("start", start);
}

void PlannerCore::abandon() {
  m_sliced.reset();
  m_known.reset();
}

/** No search at all if the vehicle is on a path that is free and nothing can cost clearly less. */
std::optional<PlanResult> PlannerCore::prepareAgain(const Place& start,
                                                    std::optional<PlanResult>& rest) {
  PlanResult result;
  abandon();
  if (refuse(start, m_goalPlace, result)) return result;
  if (!needsRoadmap(m_options)) rest = m_kept.restFrom(*m_startPose);
  return rest && m_kept.isOfThisGround() ? rest : std::nullopt;
}

PlanResult PlannerCore::replan(const Place& start) {
  StageClock clock;
  std::optional<PlanResult> rest;
  checkReplan(start);
  const Change change(*this);
  if (const auto known = prepareAgain(start, rest)) return *known;
  return take(solve({checkerOfSearch(), *m_startPose, *m_goalPose, rest}, clock), clock);
}

PlannerCore::~PlannerCore() = default;

void PlannerCore::begin(const Place& start, const std::optional<Place>& goal) {
  StageClock clock;
  std::optional<PlanResult> rest;
  if (goal) checkFinite("start", start), checkFinite("goal", *goal);
  if (!goal) checkReplan(start);
  const Change change(*this);
  m_known = goal ? prepare(start, *goal, clock) : prepareAgain(start, rest);
  if (!m_known && mayNeedRoadmap(m_options))
    m_known = take(solve({checkerOfSearch(), *m_startPose, *m_goalPose, rest}, clock), clock);
  if (!m_known) m_sliced = std::make_unique<Sliced>(*this, std::move(rest));
}

std::optional<PlanResult> PlannerCore::goOn(std::size_t& work) {
  checkWhole();
  if (!m_known && !m_sliced) throw std::logic_error("SemanticPlanner: no plan was begun");
  const Change change(*this);
  if (m_known) return std::exchange(m_known, {});
  if (!m_sliced->slices.goOn(work)) return std::nullopt;
  const std::unique_ptr<Sliced> done = std::move(m_sliced);
  PlanResult result = take(std::move(done->solution), done->clock);
  m_kept.groundChanged(done->changed);
  if (!result.found() || m_kept.isKept()) return result;
  m_sliced = std::make_unique<Sliced>(*this, std::nullopt);  // something is on the path by now
  return goOn(work);
}

}  // namespace semantic_planning
