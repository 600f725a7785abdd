#pragma once
#include <semantic_driving/PathCheck.h>
#include <semantic_planning/planner/SemanticPlanner.h>

#include <optional>

namespace semantic_driving {

/** Finds turns ahead in the place of changes of gear, on the planner's ground as it is now.
 *
 * A planner that puts classes before the price of driving backs up on grass wherever that takes
 * fewer meters of grass than turning around ahead. Where all is grass it does not matter. */
class ForwardTurns {
 public:
  /** \param planner must outlive this \param longest stretch backwards that is not too long, m */
  explicit ForwardTurns(const semantic_planning::SemanticPlanner& planner,
                        double longest = PathJudgment::kLongestBackwards);

  /** The path with a shortest curve that only goes forward (ReedsShepp::connectForward()) between
   * two of its places with changes of gear between them, of the least MotionCost. The curve goes
   * over no worse class than the part in whose place it is, or than the whole path if that has too
   * long a stretch backwards, but may be longer there.
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

}  // namespace semantic_driving
