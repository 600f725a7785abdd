#pragma once
#include <semantic_driving/DrivePath.h>
#include <semantic_planning/planner/SemanticPlanner.h>

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace semantic_driving {

/** What the map says of a path that was planned some time ago. */
struct PathJudgment {
  /** Meters from where it was looked at to where the vehicle does not fit, or must not be. */
  double freeFor = std::numeric_limits<double>::infinity();
  double longestBackwards = 0;  ///< stretch, meters
  /** What driving the whole path costs, classes included, as PlanResult::price; meters. An
   * infinite rate counts as the highest finite one to the power of its rank. */
  double price = 0;

  bool isFree() const { return freeFor == std::numeric_limits<double>::infinity(); }
  static constexpr double kSameLength = 0.5;  ///< paths that differ by less are as good, meters
  static constexpr double kSameShare = 0.1;   ///< or by less of the other one's price
  /** Nobody backs up farther at a stretch if it can be helped, meters. */
  static constexpr double kLongestBackwards = 4;

  /** No long stretch backwards before a lower price. */
  bool isClearlyBetterThan(const PathJudgment& other) const;
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

/** Finds turns ahead in the place of changes of gear, on the planner's ground as it is now.
 *
 * A planner that puts classes before the price of driving backs up on grass wherever that takes
 * fewer meters of grass than turning around ahead. Where all is grass it does not matter. */
class ForwardTurns {
 public:
  /** \param planner must outlive this \param longest stretch backwards that is not too long, m */
  explicit ForwardTurns(const semantic_planning::SemanticPlanner& planner,
                        double longest = PathJudgment::kLongestBackwards);

  /** The path of the least MotionCost with a shortest curve that only goes forward
   * (ReedsShepp::connectForward()), in place of a part with changes of gear. There the curve may be
   * longer, but over no worse class than that part has, or the whole path if it goes backwards too
   * far.
   * \param from arc length up to which the path stays, meters \param worth by so much the price has
   * to be lower, meters forward \return nothing if there is none */
  std::optional<DrivePath> find(const DrivePath& path, double from, double worth) const;

 private:
  struct Curve {
    double from, to, price;  ///< arc lengths; of the whole path
    semantic_planning::ReedsSheppCurve curve;
  };
  std::vector<double> places(const DrivePath& path, double from) const;
  std::vector<Curve> curves(const DrivePath& path, double from, double most) const;
  double priceOf(const DrivePath& path, double from, double to) const;
  colored_graph::Rank worstOf(const DrivePath& path) const;
  bool isDrivable(const Curve& c, const DrivePath& path) const;

  const semantic_planning::SemanticPlanner& m_planner;
  semantic_planning::CollisionChecker m_checker;
  double m_longest;
};

/** What keeps a vehicle from standing at a goal. */
struct GoalMisfit {
  mrpt::math::TPoint2D at;  ///< the middle of a column that is in the way, map frame, meters
  semantic_types::ClassId classId = semantic_types::kNoClass;  ///< of what is there
};

/** What is known to be in the way of a vehicle at a goal or of its clearance, nearest first; empty
 * if nothing, or too little is known. As SemanticPlanner::check() does, but for what is not known:
 * that may turn out to be ground.
 *
 * Heights of the ground spread from below the vehicle. Beyond ground that was not seen they are
 * guessed, so that only what stands next to ground that was seen counts.
 * \param from where the vehicle is, on ground of height z (meters) */
std::optional<GoalMisfit> findMisfit(const semantic_planning::SemanticPlanner& planner,
                                     const mrpt::math::TPose2D& from, double z,
                                     const mrpt::math::TPose2D& goal);

/** The pose nearest to a goal where the vehicle fits and can get to over known ground: least
 * distance, a half turn counting as 1.5 m. Nothing if there is none within a distance (meters).
 * \param from where the vehicle is, on ground of height z (meters) */
std::optional<mrpt::math::TPose2D> nearestFit(const semantic_planning::SemanticPlanner& planner,
                                              const mrpt::math::TPose2D& from, double z,
                                              const mrpt::math::TPose2D& goal, double within);

/** A sentence on what is in the goal's way. */
std::string describe(const GoalMisfit& misfit, const mrpt::math::TPose2D& goal,
                     const semantic_types::ClassTable& classes);

}  // namespace semantic_driving
