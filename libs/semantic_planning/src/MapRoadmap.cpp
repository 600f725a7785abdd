#include "MapRoadmap.h"

#include <algorithm>
#include <functional>

namespace semantic_planning {

using semantic_octree::Abstraction;
using semantic_octree::LeafCell;

namespace {

constexpr std::size_t kDefaultVertices = 1000;

RoadmapOptions withDefaults(RoadmapOptions options) {
  const bool finite = options.kind == GraphKind::Compressed || options.kind == GraphKind::Full;
  if (!finite && options.vertices == 0) options.vertices = kDefaultVertices;
  return options;
}

}  // namespace

MapRoadmap::MapRoadmap(semantic_octree::SemanticOcTree& map, const EdgeChecker& checker,
                       const RoadmapOptions& options, const GroundPose& start,
                       const GroundPose& goal)
    : m_map(map),
      m_checker(checker),
      m_options(withDefaults(options)),
      m_region(start.pose, goal.pose, options.regionBuffer),
      m_start(start),
      m_roadmap(checker, m_options),
      m_pool(checker, m_roadmap) {
  if (m_options.kind == GraphKind::Compressed)
    takeByPriority(compressedCandidates());
  else if (m_options.kind == GraphKind::Full)
    takeByPriority(fullCandidates());
  else
    takeHalton();
  m_pool.apply();
  if (m_options.edges > 0) m_roadmap.limitEdges(m_options.edges);
}

bool MapRoadmap::reachable(const Candidate& candidate) const {
  const Ground& ground = m_checker.ground();
  const auto pointAt = [&](const GroundPose& p) {
    const Column column = ground.columnAt(p.pose.x, p.pose.y);
    const Surface* s = ground.near(column, p.z, ground.step());
    return s ? std::optional<GroundPoint>({column, *s}) : std::nullopt;
  };
  const auto from = pointAt(m_start), to = pointAt(candidate.pose);
  return from && to && ground.connected(*from, *to);
}

std::vector<MapRoadmap::Offer> MapRoadmap::compressedCandidates() {
  const Abstraction abstraction(m_map);
  std::vector<Offer> offers;
  for (const LeafCell& leaf : abstraction.leaves())
    for (const Candidate& candidate : candidatesIn(leaf, abstraction, search()))
      offers.push_back({candidate, VertexPool::idOf(leaf)});
  return offers;
}

std::vector<MapRoadmap::Offer> MapRoadmap::fullCandidates() const {
  std::vector<Offer> offers;
  for (const Candidate& candidate : gridCandidates(search())) offers.push_back({candidate, {}});
  return offers;
}

void MapRoadmap::takeByPriority(const std::vector<Offer>& offers) {
  std::vector<std::pair<double, std::size_t>> queue;  // a heap: few of many are taken
  for (std::size_t i = 0; i < offers.size(); ++i)
    queue.emplace_back(offers[i].candidate.priority, i);
  std::make_heap(queue.begin(), queue.end(), std::greater<>());
  std::size_t usable = 0;
  for (; !queue.empty(); queue.pop_back()) {
    std::pop_heap(queue.begin(), queue.end(), std::greater<>());
    const auto& [priority, index] = queue.back();
    const Offer& offer = offers[index];
    if (m_options.vertices > 0 && usable == m_options.vertices) {
      m_lastPriority = priority;
      return;
    }
    if (!reachable(offer.candidate)) continue;
    m_pool.add(offer.candidate, offer.leaf);
    usable += m_pool.isUsable(offer.candidate);
  }
}

void MapRoadmap::takeHalton() {
  std::size_t draws = 0, usable = 0;
  drawHalton(search(), m_checker.order(), [&](const std::optional<Candidate>& candidate) {
    ++draws;
    if (candidate && reachable(*candidate)) {
      m_pool.add(*candidate);
      usable += m_pool.isUsable(*candidate);
    }
    const bool plain = m_options.kind == GraphKind::Halton;
    return (plain ? draws : usable) == m_options.vertices;
  });
}

void MapRoadmap::update(const std::vector<Column>& changedTiles) {
  m_pool.refresh(changedTiles);
  if (m_options.kind == GraphKind::Compressed) followLeaves();
  m_pool.apply();
  m_roadmap.refresh(changedTiles);
}

void MapRoadmap::followLeaves() {
  Abstraction abstraction(m_map);
  const semantic_octree::TreeChange change = abstraction.takeChange();
  for (const LeafCell& leaf : change.removed) m_pool.removeLeaf(VertexPool::idOf(leaf));
  for (const LeafCell& leaf : change.added) {
    if (m_pool.holds(VertexPool::idOf(leaf))) continue;  // it came before the roadmap
    for (const Candidate& candidate : candidatesIn(leaf, abstraction, search()))
      if (candidate.priority < m_lastPriority && reachable(candidate))
        m_pool.add(candidate, VertexPool::idOf(leaf));
  }
}

}  // namespace semantic_planning
