#include "MapRoadmap.h"

#include <algorithm>
#include <limits>
#include <queue>

#include "TileMarks.h"
#include "ground/ColumnGrid.h"

namespace semantic_planning {

using colored_graph::kNoVertex;

bool MapRoadmap::isUsable(const GroundPose& candidate) const {
  return m_checker.fit(candidate) == Fit::Free &&
         m_checker.order().rank(m_checker.classAt(candidate)) != colored_graph::kForbidden;
}

void MapRoadmap::add(const GroundPose& candidate, const std::optional<CandidatePoint>& point) {
  std::size_t index = m_members.size();
  if (m_free.empty()) {
    m_members.emplace_back();
  } else {
    index = m_free.back();
    m_free.pop_back();
  }
  m_members[index] = {candidate, kNoVertex, true};
  if (point) m_ofPoint[*point].push_back(index);
  if (isUsable(candidate)) m_toInsert.push_back(index);
}

void MapRoadmap::dropVertex(Member& member) {
  if (member.vertex != kNoVertex) m_toRemove.push_back(member.vertex);
  member.vertex = kNoVertex;
}

void MapRoadmap::remove(const CandidatePoint& point) {
  const auto found = m_ofPoint.find(point);
  if (found == m_ofPoint.end()) return;
  for (const std::size_t index : found->second) {
    dropVertex(m_members[index]);
    m_members[index].present = false;
    m_free.push_back(index);
  }
  m_ofPoint.erase(found);
}

/** The ground may have gone up or down by what the wheels climb. */
bool MapRoadmap::standsOnGround(Member& member) {
  GroundPose& pose = member.candidate;
  const Ground& ground = m_checker.ground();
  const Column column = ground.columnAt(pose.pose.x, pose.pose.y);
  const Surface* s = ground.near(column, pose.z, ground.step());
  if (!s || s->z == pose.z) return s != nullptr;
  pose.z = s->z;
  dropVertex(member);
  return true;
}

void MapRoadmap::look(std::size_t index) {
  Member& member = m_members[index];
  if (!standsOnGround(member) || !isUsable(member.candidate)) return dropVertex(member);
  if (member.vertex == kNoVertex) {
    m_toInsert.push_back(index);
  } else if (const ClassId id = m_checker.classAt(member.candidate);
             id != m_roadmap.graph().vertexClass(member.vertex)) {
    m_roadmap.graph().setVertexClass(member.vertex, id);
    ++m_counts.recolored;
  }
}

void MapRoadmap::apply() {
  std::vector<std::size_t> inserted;
  std::vector<GroundPose> poses;
  std::vector<ClassId> classes;
  std::sort(m_toInsert.begin(), m_toInsert.end());
  m_toInsert.erase(std::unique(m_toInsert.begin(), m_toInsert.end()), m_toInsert.end());
  for (const std::size_t index : m_toInsert) {
    const Member& member = m_members[index];
    if (!member.present || member.vertex != kNoVertex || !isUsable(member.candidate)) continue;
    inserted.push_back(index);
    poses.push_back(member.candidate);
    classes.push_back(m_checker.classAt(member.candidate));
  }
  if (!poses.empty() || !m_toRemove.empty()) {
    const auto ids = m_roadmap.replace(m_toRemove, poses, classes);
    for (std::size_t i = 0; i < ids.size(); ++i) m_members[inserted[i]].vertex = ids[i];
  }
  m_counts.inserted += poses.size();
  m_counts.removed += m_toRemove.size();
  m_toInsert.clear();
  m_toRemove.clear();
}

namespace {

constexpr std::size_t kDefaultVertices = 1000;
constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

/** Whether a kind takes its vertices from a store. */
bool isFinite(GraphKind kind) { return isOfTree(kind) || kind == GraphKind::Full; }

RoadmapOptions withDefaults(RoadmapOptions options) {
  if (!isFinite(options.kind) && options.vertices == 0) options.vertices = kDefaultVertices;
  return options;
}

}  // namespace

MapRoadmap::MapRoadmap(CandidateStore& store, const CollisionChecker& checker,
                       const RoadmapOptions& options, const GroundPose& start,
                       const PlanningRegion& region)
    : m_checker(checker),
      m_options(withDefaults(options)),
      m_region(region),
      m_start(start),
      m_roadmap(checker, m_options) {
  if (isFinite(m_options.kind))
    takeByPriority(store);
  else
    takeHalton();
  apply();
}

bool MapRoadmap::reachable(const GroundPose& pose) const {
  const Ground& ground = m_checker.ground();
  const auto pointAt = [&](const GroundPose& p) {
    const Column column = ground.columnAt(p.pose.x, p.pose.y);
    const Surface* s = ground.near(column, p.z, ground.step());
    return s ? std::optional<GroundPoint>({column, *s}) : std::nullopt;
  };
  const auto from = pointAt(m_start), to = pointAt(pose);
  return from && to && ground.connected(*from, *to);
}

std::size_t MapRoadmap::take(const CandidatePoint& point, std::size_t most) {
  std::size_t usable = 0;
  for (const GroundPose& candidate : candidatesAt(point, m_checker, m_options)) {
    const auto& pose = candidate.pose;
    if (usable == most || !m_region.contains(pose.x, pose.y) || !reachable(candidate)) break;
    add(candidate, point);
    usable += isUsable(candidate);
  }
  return usable;
}

/** Merges the tiles' lists, each of which is sorted. */
void MapRoadmap::takeByPriority(CandidateStore& store) {
  struct List {
    const CandidatePoint *next, *end;
    bool operator<(const List& o) const { return *o.next < *next; }  // the least on top
  };
  std::priority_queue<List> lists;
  for (const Column& tile : inMortonOrder(tilesIn(m_region, m_checker.ground())))
    if (const std::vector<CandidatePoint>& points = store.in(tile); !points.empty())
      lists.push({points.data(), points.data() + points.size()});
  std::size_t left = m_options.vertices > 0 ? m_options.vertices : kUnlimited;
  while (!lists.empty() && left > 0) {
    List list = lists.top();
    lists.pop();
    left -= take(*list.next, left);
    if (++list.next != list.end) lists.push(list);
  }
  if (!lists.empty()) m_lastPriority = lists.top().next->priority;
}

std::vector<CandidatePoint> MapRoadmap::turnedPoints(const std::vector<Column>& tiles) const {
  std::vector<CandidatePoint> turned;
  if (!hasAlignedHeadings(m_options.kind)) return turned;
  const TileMarks changed(m_checker.ground(), tiles);
  for (const auto& [point, members] : m_ofPoint) {
    const auto& pose = m_members[members.front()].candidate.pose;
    if (changed.anyIn({pose.x, pose.y, kHeadingReach}) &&
        candidatesAt(point, m_checker, m_options).front().pose.phi != pose.phi)
      turned.push_back(point);
  }
  return turned;
}

/** Until there are enough, or the sequence has become hopeless. */
void MapRoadmap::takeHalton() {
  constexpr std::size_t kMostDraws = 1000;  // for each vertex asked for
  const bool isPlain = m_options.kind == GraphKind::Halton;
  const std::size_t wanted = m_options.vertices;
  std::size_t draws = 0;
  for (std::size_t usable = 0;
       (isPlain ? draws : usable) < wanted && draws < kMostDraws * wanted;) {
    const auto candidate =
        haltonPose(static_cast<unsigned>(++draws), m_region, m_checker.ground(), m_options.seed);
    if (!candidate || !reachable(*candidate)) continue;
    add(*candidate);
    usable += isUsable(*candidate);
  }
}

void MapRoadmap::update(const std::vector<Column>& changedTiles,
                        const CandidateStore::Change& points) {
  for (const CandidatePoint& point : points.removed) remove(point);
  for (const CandidatePoint& point : points.added)
    if (point.priority < m_lastPriority) take(point, kUnlimited);
  for (const CandidatePoint& point : turnedPoints(changedTiles)) {
    remove(point);
    take(point, kUnlimited);
  }
  const TileMarks changed(m_checker.ground(), changedTiles);
  for (std::size_t i = 0; i < m_members.size(); ++i) {
    const auto& pose = m_members[i].candidate.pose;
    if (m_members[i].present && changed.anyIn({pose.x, pose.y, m_checker.reach()})) look(i);
  }
  apply();
  m_roadmap.refresh(changedTiles);
}

}  // namespace semantic_planning
