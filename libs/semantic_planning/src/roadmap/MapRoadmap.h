#pragma once
#include <vector>

#include "CandidateStore.h"
#include "VertexPool.h"

namespace semantic_planning {

/** A roadmap between a start and a goal, and what keeps it up to date with the map. */
class MapRoadmap {
 public:
  /** \param store, checker must outlive the roadmap \param start on the ground */
  MapRoadmap(CandidateStore& store, const CollisionChecker& checker, const RoadmapOptions& options,
             const GroundPose& start, const PlanningRegion& region);

  Roadmap& roadmap() { return m_roadmap; }
  const Roadmap& roadmap() const { return m_roadmap; }
  /** Whether the ground connects it with the start. */
  bool reachable(const GroundPose& pose) const;
  VertexPool::Counts takeVertexCounts() { return m_pool.takeCounts(); }

  /** The ground changed in these tiles, and so did points. */
  void update(const std::vector<Column>& changedTiles, const CandidateStore::Change& points);

 private:
  /** \return how many vertices it gives now, at most `most` */
  std::size_t take(const CandidatePoint& point, std::size_t most);
  std::vector<CandidatePoint> turnedPoints(const std::vector<Column>& tiles) const;
  void takeByPriority(CandidateStore& store);
  void takeHalton();

  const CollisionChecker& m_checker;
  const RoadmapOptions m_options;
  const PlanningRegion m_region;
  const GroundPose m_start;
  Roadmap m_roadmap;
  VertexPool m_pool;
  double m_lastPriority = 1;  ///< points from it on are not taken
};

}  // namespace semantic_planning
