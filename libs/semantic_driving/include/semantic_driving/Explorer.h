#pragma once
#include <semantic_driving/DrivePath.h>
#include <semantic_planning/planner/SemanticPlanner.h>
#include <semantic_planning/planner/Slices.h>

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace semantic_driving {

/** How far over known ground places to drive to are looked for, meters; a wall beyond is
 * forgotten. */
constexpr double kFrontierRadius = 80;

/** A place at the border of what is known. */
struct Frontier {
  mrpt::math::TPose2D pose;  ///< headed as one comes there
  double z = 0;              ///< height of the ground, meters
  double cost = 0;           ///< weighted meters by way of it to the goal
};

/** What exploring took, in weighted meters as Frontier::cost. */
struct Effort {
  double spent = 0;     ///< by now
  double expected = 0;  ///< in all, when it began (Exploration::hoped); 0: it begins now
  /** What a meter through the unknown counts, relative to the first: the root of driven over
   * expected way. The freespace assumption is wrong again and again along a hedge, where it always
   * hopes for a gap just beyond what is seen.
   * \param left to the goal by now, weighted meters */
  double doubt(double left) const;
};

/** Where looking may show a way to a goal. */
struct Exploration {
  std::vector<Frontier> frontiers;  ///< most promising first
  double hoped = 0;  ///< what the first one costs if nothing is doubted, weighted meters
  /** No way leads to the goal: what is known to be in the way, or forbidden, is all around it, or
   * around the vehicle. */
  bool enclosed = false;
  /** Around the goal, up to what encloses it or is reached, square meters; infinite if it leaves
   * the radius. Then, if there is no way, the vehicle is enclosed, as it may seem where it does not
   * see its own ground. */
  double goalArea = std::numeric_limits<double>::infinity();
  /** Known ground leads to the goal's place, though perhaps not for a vehicle that has to turn, or
   * is to stand there. */
  bool goalReached = false;
};

/** Places on drivable ground next to unknown space from which to see more of the way to a goal. The
 * most promising comes first: least way there, where rank r counts r + 1 times, and on through the
 * unknown around known obstacles (the freespace assumption). Turning around costs, too. (Yamauchi,
 * "A frontier-based approach for autonomous exploration", 1997, with a goal.)
 *
 * Only what borders on the goal's region counts. That is a flood from the goal, over all but known
 * obstacles, up to where the vehicle can get. A way to the goal leaves the known ground for the
 * last time at that border. If nothing reached borders on the region, it is enclosed: what is in
 * the way stays, and nothing yet to be seen opens a way. Gaps count as passable in doubt, as does
 * all that is farther than the radius.
 * \param from where the vehicle is and heads, on ground of height z (meters)
 * \param avoid places that are not looked for again, nor others within 3 m of them
 * \param effort until now: a meter through the unknown counts two on rank 0, times its doubt()
 * \return at most six, 3 m apart */
Exploration findFrontiers(const semantic_planning::SemanticPlanner& planner,
                          const mrpt::math::TPose2D& from, double z,
                          const mrpt::math::TPose2D& goal,
                          const std::vector<mrpt::math::TPose2D>& avoid, const Effort& effort = {});

/** Chooses places at the border of the known to drive to, each once. Where ways through the unknown
 * were hoped for in vain, it hopes for less. */
class Explorer {
 public:
  /** \param planner must outlive this. */
  explicit Explorer(semantic_planning::SemanticPlanner& planner) : m_planner(planner) {}

  /** Counts the way that the vehicle drove since the last call. \param z of the ground, meters */
  void moveTo(const mrpt::math::TPose2D& pose, double z);

  /** Where to explore. A vehicle that was near a goal whose place known ground leads to looks
   * around there only: what is missing is seen from there or not at all. \param from where the
   * vehicle leaves its path, on ground of height z */
  Exploration places(const mrpt::math::TPose2D& from, double z, const mrpt::math::TPose2D& goal);

  struct Way {
    semantic_planning::PlanResult plan;
    DrivePath path;
  };
  /** Looks for places() and chooses the one that costs least. What its path costs beyond its length
   * counts, too: changes of gear, meters backwards. Between slices of the search map and planner
   * may be updated. What was begun before is given up. */
  void begin(const mrpt::math::TPose2D& from, double z, const mrpt::math::TPose2D& goal);
  /** \param joined makes of a planned path what is driven
   * \param work as SemanticPlanner::goOn() has it \return whether the choice is made */
  bool goOn(const std::function<DrivePath(DrivePath)>& joined, std::size_t& work);
  /** The places that were found since begin(), as soon as they are. */
  const Exploration& found() const { return m_choice.exploration; }
  /** What was chosen, if any can be reached.
   * \param last places that are not reached are not tried again, even if none can be */
  std::optional<Way> chosen(bool last);
  /** Gives up what was begun. */
  void giveUp() { m_choice = {}; }
  /** The way that was chosen last is driven, or not: then its place may be chosen again. */
  void end(bool drives);

  /** Places that were driven to, or could not be reached. None is looked at twice, nor others
   * within 3 m of it: exploring comes to an end. */
  std::size_t explored() const { return m_seen.size(); }
  /** Whether nothing is left to be looked at around a goal that known ground leads to. */
  bool exhausted() const { return m_exhausted; }

 private:
  using Poses = std::vector<mrpt::math::TPose2D>;
  /** One that is being made. */
  struct Choice {
    mrpt::math::TPose2D from;
    double z = 0;
    Exploration exploration;
    std::unique_ptr<semantic_planning::Slices> search;  ///< for it
    std::size_t next = 0;                               ///< of its frontiers
    bool isPlanning = false;
    std::optional<Frontier> best;
    std::optional<Way> way;  ///< to the best one
    Poses useless;           ///< what is not seen from there, is not seen
  };

  void consider(Frontier f, semantic_planning::PlanResult plan,
                const std::function<DrivePath(DrivePath)>& joined);

  semantic_planning::SemanticPlanner& m_planner;
  Effort m_effort;
  Choice m_choice;
  bool m_wasThere = false, m_exhausted = false;
  std::optional<mrpt::math::TPose2D> m_pose;  ///< where the vehicle was last
  Poses m_seen;                               ///< visited, or not to be reached
  Poses m_tried;                              ///< the same, if the way that was chosen is driven
};

}  // namespace semantic_driving
