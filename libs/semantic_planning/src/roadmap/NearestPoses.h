#pragma once
#include <colored_graph/ColoredGraph.h>
#include <semantic_planning/roadmap/PosePair.h>

#include <vector>

#include "ground/ColumnGrid.h"

namespace semantic_planning {

/** Each pose's k nearest poses, in Reeds-Shepp distance up to a radius, exactly, while poses come
 * and go. Ties go by the poses' order, whatever their ids are. */
class NearestPoses {
 public:
  using VertexId = colored_graph::VertexId;
  struct Neighbor {
    VertexId id;
    double distance;  ///< meters
    GroundPose pose;
    bool operator<(const Neighbor& o) const {
      return distance != o.distance ? distance < o.distance : isBefore(pose, o.pose);
    }
  };

  /** \param reedsShepp must outlive this. */
  NearestPoses(const ReedsShepp& reedsShepp, int neighbors, double radius);

  /** Removes some, then inserts others, which may have their ids. */
  void replace(const std::vector<VertexId>& removed, const std::vector<VertexId>& ids,
               const std::vector<GroundPose>& poses);

  bool contains(VertexId v) const { return v < m_entries.size() && m_entries[v].present; }
  const GroundPose& pose(VertexId v) const { return m_entries[v].pose; }
  /** Nearest first. */
  const std::vector<Neighbor>& of(VertexId v) const { return m_entries[v].nearest; }
  /** The `count` nearest to a pose, of all but one. */
  std::vector<Neighbor> nearestTo(const GroundPose& pose, std::size_t count,
                                  VertexId but = colored_graph::kNoVertex) const;

 private:
  struct Entry {
    bool present = false;
    GroundPose pose;
    std::vector<Neighbor> nearest;
  };
  Column cellOf(const mrpt::math::TPose2D& pose) const;
  /** f(id) for all poses within a radius, and some beyond. */
  template <class F>
  void forNear(const mrpt::math::TPose2D& pose, double radius, F f) const;

  const ReedsShepp& m_reedsShepp;
  std::size_t m_count;
  double m_radius;
  std::vector<Entry> m_entries;
  ColumnGrid<std::vector<VertexId>> m_cells;
};

}  // namespace semantic_planning
