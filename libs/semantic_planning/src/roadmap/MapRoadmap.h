#pragma once
#include <semantic_planning/roadmap/Roadmap.h>

#include <map>
#include <vector>

#include "Candidates.h"

namespace semantic_planning {

/** A roadmap between a start and a goal. Its vertices are those of one that is made anew, whatever
 * the map was before. */
class MapRoadmap {
 public:
  /** \param map, checker must outlive the roadmap \param start on the ground */
  MapRoadmap(semantic_octree::SemanticOcTree& map, const CollisionChecker& checker,
             const RoadmapOptions& options, const GroundPose& start, const PlanningRegion& region);

  Roadmap& roadmap() { return m_roadmap; }

  /** The ground changed in these tiles. */
  void update(const std::vector<Column>& changedTiles);

 private:
  struct IsBefore {
    bool operator()(const GroundPose& a, const GroundPose& b) const { return isBefore(a, b); }
  };

  /** Whether it can be a vertex: the ground connects it with the start. */
  bool isReachable(const GroundPose& pose) const;
  bool isUsable(const GroundPose& pose) const;
  /** Poses for vertices. */
  std::vector<GroundPose> byPriority() const;
  std::vector<GroundPose> ofHalton() const;

  semantic_octree::SemanticOcTree& m_map;  ///< keeps G-values for kinds of the tree (isOfTree)
  const CollisionChecker& m_checker;
  const RoadmapOptions m_options;
  const PlanningRegion m_region;
  const GroundPose m_start;
  Roadmap m_roadmap;
  std::map<GroundPose, colored_graph::VertexId, IsBefore> m_vertices;
};

}  // namespace semantic_planning
