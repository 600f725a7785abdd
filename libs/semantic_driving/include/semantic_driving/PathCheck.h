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
  double longestBackwards = 0;        ///< stretch, meters
  double price = 0;  ///< of driving all of it (semantic_planning::MotionCost), meters forward

  bool isFree() const { return freeFor == std::numeric_limits<double>::infinity(); }
  static constexpr double kSameLength = 0.5;  ///< paths that differ by less are as good, meters
  static constexpr double kSameShare = 0.1;   ///< or by less of the other path's length, or price
  /** Nobody backs up farther at a stretch if it can be helped, meters. */
  static constexpr double kLongestBackwards = 4;

  /** No long stretch backwards before classes before the price of driving.
   * \param mostBackwards longer stretches are long, meters */
  bool isClearlyBetterThan(const PathJudgment& other,
                           double mostBackwards = kLongestBackwards) const;
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
  semantic_planning::CollisionChecker m_checker;
};

}  // namespace semantic_driving
