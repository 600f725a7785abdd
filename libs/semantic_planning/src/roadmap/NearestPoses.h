#pragma once
#include <colored_graph/ColoredGraph.h>
#include <semantic_planning/roadmap/PosePair.h>

#include <utility>
#include <vector>

#include "ground/ColumnGrid.h"

namespace semantic_planning {

/** The k nearest poses of each pose, in Reeds-Shepp distance up to a radius, exactly (ties go by
 * the poses' order, whatever their ids are), while poses come and go. */
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
  using Pair = std::pair<VertexId, VertexId>;  ///< smaller id first

  /** \param reedsShepp must outlive this. */
  NearestPoses(const ReedsShepp& reedsShepp, int neighbors, double radius);

  /** Removes some, then inserts others, which may have their ids.
   * \return the pairs that may have become, or ceased to be, neighbors; sorted */
  std::vector<Pair> replace(const std::vector<VertexId>& removed, const std::vector<VertexId>& ids,
                            const std::vector<GroundPose>& poses);

  bool contains(VertexId v) const { return v < m_entries.size() && m_entries[v].present; }
  const GroundPose& pose(VertexId v) const { return m_entries[v].pose; }
  /** Nearest first. */
  const std::vector<Neighbor>& of(VertexId v) const { return m_entries[v].nearest; }
  /** Whether one of them is among the other's nearest. */
  bool linked(VertexId a, VertexId b) const;
  /** The `count` nearest to a pose that need not be among these. */
  std::vector<Neighbor> nearestTo(const GroundPose& pose, std::size_t count) const;

 private:
  struct Entry {
    bool present = false;
    GroundPose pose;
    std::vector<Neighbor> nearest;
  };
  struct PairBound {
    double bound;
    VertexId a, b;
    bool operator<(const PairBound& o) const { return bound < o.bound; }
  };
  Column cellOf(const mrpt::math::TPose2D& pose) const;
  /** f(id, squared distance on the plane) for all poses within a radius. */
  template <class F>
  void forWithin(const mrpt::math::TPose2D& pose, double radius, F f) const;
  bool isFull(const Entry& entry) const { return entry.nearest.size() == m_count; }
  /** Only poses nearer than this can become its neighbors. */
  double farthest(const Entry& entry) const;
  void offer(VertexId to, const Neighbor& neighbor);
  /** Whether one of a pair may still become the other's neighbor: less and less so. */
  bool mayCount(const PairBound& pair) const;
  /** Solves for the pairs' distances, most promising first, where they may still count. */
  void relax(std::vector<PairBound>& pairs);
  void place(VertexId id, const GroundPose& pose);
  void forget(VertexId id);
  /** Takes what is not present any more out of all lists. \return whose were full */
  std::vector<VertexId> dropForgotten();
  /** Pairs that may count, farther than `beyond`, up to `radius`, for the entries still `open`. */
  std::vector<PairBound> pairsOf(const std::vector<VertexId>& open, double beyond,
                                 double radius) const;
  double firstRadius() const;
  /** Finds the neighbors that entries lack, looking farther and farther, at first up to `radius`.
   */
  void complete(std::vector<VertexId> open, double radius);
  std::vector<Pair> takeChanged();

  const ReedsShepp& m_reedsShepp;
  std::size_t m_count;
  double m_radius, m_cellSize;
  std::vector<Entry> m_entries;
  ColumnGrid<std::vector<VertexId>> m_cells;
  std::size_t m_present = 0;
  std::vector<Pair> m_changed;
};

}  // namespace semantic_planning
