#pragma once
#include <colored_graph/ClassOrder.h>
#include <colored_graph/Edge.h>
#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <string>
#include <vector>

namespace planning_study {

using colored_graph::Length;

/** A task for all planners. Meters, radians; map frame. */
struct Instance {
  mrpt::math::TPose2D start, goal;
  double distance() const;
};

/** What came of one instance, one way to plan, and one budget. */
struct Trial {
  std::string map;
  std::size_t instance = 0;
  Instance task;
  std::string judgment;    ///< how edges were judged: endpoint, sweep, profile, weighted
  std::string graph;       ///< its kind, or the name of a peer
  std::size_t budget = 0;  ///< vertices asked for; peers: milliseconds
  /** Whether the planner remembers edges from the tasks before. */
  bool kept = false;
  std::string status;  ///< of the search, in words
  bool found = false;
  std::size_t vertices = 0, edges = 0, evaluated = 0, expansions = 0;
  /** Processor time, milliseconds. */
  double graphTime = 0, evaluationTime = 0, searchTime = 0;
  double firstPathTime = 0;  ///< of peers, which go on until their time is over
  /** Worst rank first, total last: what was minimized. */
  std::vector<std::int64_t> cost;
  /** What the path goes over, for every kind of search. Lengths in the worst rank, ..., in rank 1;
   * total. Empty if there is no path. */
  std::vector<Length> way;

  double planningTime() const { return evaluationTime + searchTime; }
  double totalTime() const { return graphTime + planningTime(); }
  double timeToFirstPath() const { return firstPathTime > 0 ? firstPathTime : totalTime(); }
};

/** Trial::kept in words: "kept" or "cold". */
const char* memoryName(bool kept);

/** Trial::way of a path. */
std::vector<Length> wayOf(const std::vector<Length>& lengthPerClass,
                          const colored_graph::ClassOrder& order);

/** Negative, 0 or positive, as the first is better than, equal to or worse than the other. No path
 * is worse than any. \param part Trial::way or Trial::cost. */
template <class Part>
int compareTrials(const Trial& a, const Trial& b, Part part) {
  if (a.found != b.found) return a.found ? -1 : 1;
  if (!a.found || a.*part == b.*part) return 0;
  return a.*part < b.*part ? -1 : 1;
}

}  // namespace planning_study
