#pragma once
#include <semantic_planning/roadmap/Roadmap.h>

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "Candidates.h"

namespace semantic_planning {

/** A roadmap between a start and a goal, and what keeps it up to date with the map: poses that are
 * its vertices whenever the ground lets them. */
class MapRoadmap {
 public:
  /** Vertices, counted since the last take. */
  struct Counts {
    std::size_t inserted = 0, removed = 0, recolored = 0;
  };

  /** \param store, checker must outlive the roadmap \param start on the ground */
  MapRoadmap(CandidateStore& store, const CollisionChecker& checker, const RoadmapOptions& options,
             const GroundPose& start, const PlanningRegion& region);

  Roadmap& roadmap() { return m_roadmap; }
  Counts takeVertexCounts() { return std::exchange(m_counts, {}); }

  /** The ground changed in these tiles, and so did points. */
  void update(const std::vector<Column>& changedTiles, const CandidateStore::Change& points);

 private:
  struct Member {
    GroundPose candidate;
    colored_graph::VertexId vertex = colored_graph::kNoVertex;
    bool present = false;
  };

  /** Whether the ground connects it with the start. */
  bool reachable(const GroundPose& pose) const;
  /** Whether a candidate could be a vertex now. */
  bool isUsable(const GroundPose& candidate) const;
  /** Changes take effect in the roadmap with apply(). */
  void add(const GroundPose& candidate, const std::optional<CandidatePoint>& point = {});
  /** Removes what was added with this point. */
  void remove(const CandidatePoint& point);
  /** \return how many vertices it gives now, at most `most` */
  std::size_t take(const CandidatePoint& point, std::size_t most);
  void takeByPriority(CandidateStore& store);
  void takeHalton();
  /** Points around which the ground changed so that they have other headings now. */
  std::vector<CandidatePoint> turnedPoints(const std::vector<Column>& tiles) const;
  void look(std::size_t member);
  void dropVertex(Member& member);
  bool standsOnGround(Member& member);
  void apply();

  const CollisionChecker& m_checker;
  const RoadmapOptions m_options;
  const PlanningRegion m_region;
  const GroundPose m_start;
  Roadmap m_roadmap;
  double m_lastPriority = 1;  ///< points from it on are not taken
  std::vector<Member> m_members;
  std::vector<std::size_t> m_free;
  std::map<CandidatePoint, std::vector<std::size_t>> m_ofPoint;
  std::vector<std::size_t> m_toInsert;
  std::vector<colored_graph::VertexId> m_toRemove;
  Counts m_counts;
};

}  // namespace semantic_planning
