#pragma once
#include <semantic_planning/roadmap/Roadmap.h>

#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "Candidates.h"

namespace semantic_planning {

/** The poses that are vertices of a roadmap whenever the ground lets them. */
class VertexPool {
 public:
  /** Counted since the last take. */
  struct Counts {
    std::size_t inserted = 0, removed = 0, recolored = 0;
  };

  VertexPool(const CollisionChecker& checker, Roadmap& roadmap)
      : m_checker(checker), m_roadmap(roadmap) {}

  /** Whether a candidate could be a vertex now. */
  bool isUsable(const GroundPose& candidate) const;

  /** Changes take effect in the roadmap with apply(). */
  void add(const GroundPose& candidate, const std::optional<CandidatePoint>& point = {});
  /** Removes what was added with this point. */
  void remove(const CandidatePoint& point);
  /** The points that were added and lie near these tiles, and whose first candidate's heading is
   * another one now. */
  std::vector<CandidatePoint> turnedPoints(
      const std::vector<Column>& tiles, double distance,
      const std::function<double(const CandidatePoint&)>& headingOf) const;
  /** Looks again at the poses near these tiles. */
  void refresh(const std::vector<Column>& changedTiles);
  void apply();

  Counts takeCounts() { return std::exchange(m_counts, {}); }

 private:
  struct Member {
    GroundPose candidate;
    colored_graph::VertexId vertex = colored_graph::kNoVertex;
    bool present = false;
  };

  void look(std::size_t member);
  void dropVertex(Member& member);
  bool standsOnGround(Member& member);

  const CollisionChecker& m_checker;
  Roadmap& m_roadmap;
  std::vector<Member> m_members;
  std::vector<std::size_t> m_free;
  std::map<CandidatePoint, std::vector<std::size_t>> m_ofPoint;
  std::vector<std::size_t> m_toInsert;
  std::vector<colored_graph::VertexId> m_toRemove;
  Counts m_counts;
};

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
