#pragma once
#include <semantic_driving/DrivePath.h>
#include <semantic_planning/planner/SemanticPlanner.h>

#include <limits>
#include <vector>

namespace semantic_driving {

/** By how much paths may differ and be equally good: the larger of length and share. */
struct PathTolerance {
  double length = 0.5;   ///< meters
  double share = 0.1;    ///< of a path's length, or price
  double backwards = 4;  ///< nobody backs up farther at a stretch if it can be helped, meters
};

/** What the map says of a path that was planned some time ago. */
struct PathJudgment {
  /** Meters from where it was looked at to where the vehicle does not fit, or must not be. */
  double freeFor = std::numeric_limits<double>::infinity();
  std::vector<double> lengthPerRank;  ///< meters, best rank first
  double length = 0;                  ///< meters
  double longestBackwards = 0;        ///< stretch, meters
  double price = 0;  ///< of driving all of it (semantic_planning::DrivePrice), meters forward

  bool isFree() const { return freeFor == std::numeric_limits<double>::infinity(); }
  /** No long stretch backwards before classes before the price of driving. \param tolerance its
   * share is of the other path's length where classes are compared, and of its price */
  bool isClearlyBetterThan(const PathJudgment& other, const PathTolerance& tolerance = {}) const;
};

/** Looks at paths again, on the planner's ground as it is now. */
class PathCheck {
 public:
  /** \param planner must outlive this. */
  explicit PathCheck(const semantic_planning::SemanticPlanner& planner);

  /** \param from arc length, meters */
  PathJudgment judge(const DrivePath& path, double from) const;

 private:
  const semantic_planning::SemanticPlanner& m_planner;
  semantic_planning::EdgeChecker m_checker;
};

}  // namespace semantic_driving
