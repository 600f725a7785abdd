#pragma once
#include <semantic_driving/DrivePath.h>
#include <semantic_planning/planner/SemanticPlanner.h>

#include <limits>
#include <vector>

namespace semantic_driving {

/** What the map says of a path that was planned some time ago. */
struct PathJudgment {
  /** Meters from where it was looked at to where the vehicle does not fit, or must not be. */
  double freeFor = std::numeric_limits<double>::infinity();
  std::vector<double> lengthPerRank;  ///< meters, best rank first
  double length = 0;                  ///< meters

  bool isFree() const { return freeFor == std::numeric_limits<double>::infinity(); }
  /** Classes before length; what differs by less than half a meter, or a tenth of the length, is
   * the same. */
  bool isClearlyBetterThan(const PathJudgment& other) const;
};

/** Looks at paths again, on the planner's ground as it is now. */
class DrivePathCheck {
 public:
  /** \param planner must outlive this. */
  explicit DrivePathCheck(const semantic_planning::SemanticPlanner& planner);

  /** \param from arc length, meters */
  PathJudgment judge(const DrivePath& path, double from) const;

 private:
  const semantic_planning::SemanticPlanner& m_planner;
  semantic_planning::EdgeChecker m_checker;
};

}  // namespace semantic_driving
