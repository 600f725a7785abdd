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

}  // namespace semantic_planning
