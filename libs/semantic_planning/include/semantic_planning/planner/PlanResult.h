#pragma once
#include <colored_graph/ColoredAStar.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>
#include <semantic_planning/vehicle/PathPoint.h>
#include <strict_files/OptionList.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace semantic_planning {

/** How planning ended; everything but Found says why there is no path. */
enum class PlanStatus {
  Found,
  StartOffGround,  ///< no drivable ground there
  StartBlocked,    ///< the footprint does not fit
  StartForbidden,  ///< the ground's class is
  GoalOffGround,
  GoalBlocked,
  GoalForbidden,
  NotConnected,   ///< by ground, or by the roadmap
  OnlyForbidden,  ///< all paths go through forbidden classes
  Cancelled
};
/** In words for files and people: "found", "start off ground", ... */
const strict_files::Choices<PlanStatus>& choicesOf(PlanStatus);
const char* nameOf(PlanStatus status);

/** Milliseconds of the stages that planning or an update went through, in order. */
using StageTimes = std::vector<std::pair<std::string, double>>;

struct PlanResult {
  PlanStatus status = PlanStatus::NotConnected;
  std::string reason;  ///< a sentence with the numbers; empty if found
  /** Where something is in the way of a refused start or goal, or where what can be reached comes
   * nearest to the goal; m, map frame. */
  std::optional<mrpt::math::TPoint2D> obstacle;
  /** Worst rank first: a number for each rank but rank 0, the price of driving (MotionCost), the
   * total length, in colored_graph's units (0.1 mm) or edges. A roadmap's motion cost leaves out
   * what changes where edges meet. */
  std::vector<std::int64_t> cost;
  /** Meters: MotionCost, and each rank's rate (ClassOrder) for each of its meters. An infinite rate
   * counts as a large one. */
  double price = 0;
  std::vector<double> lengthPerClass;         ///< meters by class id; [0]: unknown ground
  double length = 0;                          ///< meters
  std::vector<PathPoint> path;                ///< at most half a voxel apart
  std::vector<mrpt::math::TPose2D> vertices;  ///< where its curves meet
  std::size_t numVertices = 0, numEdges = 0;  ///< of the roadmap
  colored_graph::SearchStatistics search;
  StageTimes times;

  bool found() const { return status == PlanStatus::Found; }
};

/** What an update did. */
struct UpdateResult {
  std::size_t tilesTouched = 0;  ///< of 8 x 8 x 8 voxels of the map
  std::size_t tilesChanged = 0;  ///< of the ground
  StageTimes times;
};

}  // namespace semantic_planning
