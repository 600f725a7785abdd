#include "MapRoadmap.h"

#include <algorithm>
#include <limits>

#include "ground/ColumnGrid.h"

namespace semantic_planning {

namespace {

RoadmapOptions withDefaults(RoadmapOptions options) {
  constexpr std::size_t kDefaultVertices = 1000;
  if (options.vertices == 0)
    options.vertices =
        isOfTree(options.kind) ? std::numeric_limits<std::size_t>::max() : kDefaultVertices;
  return options;
}

}  // namespace

MapRoadmap::MapRoadmap(semantic_octree::SemanticOcTree& map, const CollisionChecker& checker,
                       const RoadmapOptions& options, const GroundPose& start,
                       const PlanningRegion& region)
    : m_map(map),
      m_checker(checker),
      m_options(withDefaults(options)),
      m_region(region),
      m_start(start),
      m_roadmap(checker, options) {
  update({});
}

bool MapRoadmap::isReachable(const GroundPose& pose) const {
  const Ground& ground = m_checker.ground();
  const auto pointAt = [&](const GroundPose& p) {
    const Column column = ground.columnAt(p.pose.x, p.pose.y);
    const Surface* s = ground.near(column, p.z, ground.step());
    return s ? std::optional<GroundPoint>({column, *s}) : std::nullopt;
  };
  const auto from = pointAt(m_start), to = pointAt(pose);
  return from && to && ground.connected(*from, *to);
}

bool MapRoadmap::isUsable(const GroundPose& pose) const {
  return m_checker.fit(pose) == Fit::Free &&
         m_checker.order().rank(m_checker.classAt(pose)) != colored_graph::kForbidden;
}

std::vector<GroundPose> MapRoadmap::byPriority() const {
  const Ground& ground = m_checker.ground();
  const semantic_octree::Abstraction abstraction(m_map);
  std::vector<CandidatePoint> points;
  for (const Column& tile : inMortonOrder(tilesIn(m_region, ground))) {
    const auto more = compressedPoints(tile, abstraction, ground, m_options);
    points.insert(points.end(), more.begin(), more.end());
  }
  const auto isLater = [](const CandidatePoint& l, const CandidatePoint& r) { return r < l; };
  std::make_heap(points.begin(), points.end(), isLater);
  std::vector<GroundPose> poses;
  for (; !points.empty() && poses.size() < m_options.vertices; points.pop_back()) {
    std::pop_heap(points.begin(), points.end(), isLater);
    for (const GroundPose& pose : candidatesAt(points.back(), m_checker, m_options))
      if (poses.size() < m_options.vertices && m_region.contains(pose.pose.x, pose.pose.y) &&
          isReachable(pose) && isUsable(pose))
        poses.push_back(pose);
  }
  return poses;
}

/** Until there are enough, or the sequence has become hopeless. */
std::vector<GroundPose> MapRoadmap::ofHalton() const {
  constexpr std::size_t kMostDraws = 1000;  // for each vertex asked for
  const bool isPlain = m_options.kind == GraphKind::Halton;
  std::vector<GroundPose> poses;
  std::size_t draws = 0;
  while ((isPlain ? draws : poses.size()) < m_options.vertices &&
         draws < kMostDraws * m_options.vertices) {
    const auto pose =
        haltonPose(static_cast<unsigned>(++draws), m_region, m_checker.ground(), m_options.seed);
    if (pose && isReachable(*pose) && isUsable(*pose)) poses.push_back(*pose);
  }
  return poses;
}

void MapRoadmap::update(const std::vector<Column>& changedTiles) {
  std::vector<GroundPose> inserted;
  std::vector<ClassId> classes;
  std::vector<colored_graph::VertexId> removed;
  auto before = std::exchange(m_vertices, {});
  for (const GroundPose& pose : isOfTree(m_options.kind) ? byPriority() : ofHalton()) {
    const ClassId id = m_checker.classAt(pose);
    if (const auto stays = before.find(pose); stays == before.end()) {
      inserted.push_back(pose);
      classes.push_back(id);
    } else {
      if (m_roadmap.graph().vertexClass(stays->second) != id)
        m_roadmap.graph().setVertexClass(stays->second, id);
      m_vertices.insert(before.extract(stays));
    }
  }
  for (const auto& [pose, vertex] : before) removed.push_back(vertex);
  const auto ids = m_roadmap.replace(removed, inserted, classes);
  for (std::size_t i = 0; i < ids.size(); ++i) m_vertices.emplace(inserted[i], ids[i]);
  m_roadmap.refresh(changedTiles);
}

}  // namespace semantic_planning
