#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <optional>
#include <vector>

#include "VertexPool.h"

namespace semantic_planning {

/** A roadmap between a start and a goal, and what keeps it up to date with the map. */
class MapRoadmap {
 public:
  /** \param start, goal on the ground \throw std::logic_error GraphKind::Compressed, and the map
   * keeps no G-values. */
  MapRoadmap(semantic_octree::SemanticOcTree& map, const EdgeChecker& checker,
             const RoadmapOptions& options, const GroundPose& start, const GroundPose& goal);

  Roadmap& roadmap() { return m_roadmap; }
  const Roadmap& roadmap() const { return m_roadmap; }
  VertexPool::Counts takeVertexCounts() { return m_pool.takeCounts(); }

  /** The ground changed in these tiles, and perhaps the compressed tree. */
  void update(const std::vector<Column>& changedTiles);

 private:
  struct Offer {
    Candidate candidate;
    std::optional<VertexPool::LeafId> leaf;
  };

  CandidateSearch search() const { return {m_checker.ground(), m_options, m_region}; }
  bool reachable(const Candidate& candidate) const;
  std::vector<Offer> compressedCandidates();
  std::vector<Offer> fullCandidates() const;
  void takeByPriority(const std::vector<Offer>& offers);
  void takeHalton();
  void followLeaves();

  semantic_octree::SemanticOcTree& m_map;
  const EdgeChecker& m_checker;
  const RoadmapOptions m_options;
  const PlanningRegion m_region;
  const GroundPose m_start;
  Roadmap m_roadmap;
  VertexPool m_pool;
  double m_lastPriority = 1;  ///< candidates above it are not taken
};

}  // namespace semantic_planning
