#pragma once
#include <semantic_driving/DrivePath.h>
#include <semantic_driving/Frontiers.h>
#include <semantic_planning/planner/SemanticPlanner.h>

#include <functional>
#include <optional>
#include <vector>

namespace semantic_driving {

/** Chooses places at the border of what is known to drive to, each once, and keeps account of what
 * that costs: where ways through the unknown were hoped for in vain, it hopes for less. */
class Explorer {
 public:
  /** \param planner must outlive this. \param radius of findFrontiers(), meters */
  Explorer(semantic_planning::SemanticPlanner& planner, double radius);

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
  /** To the one of places() that costs least, if what its path costs beyond its length, as changes
   * of gear and meters backwards do, counts, too.
   * \param joined makes of a planned path what is driven
   * \param last places that are not reached are not tried again, even if none can be */
  std::optional<Way> choose(const Exploration& places, const mrpt::math::TPose2D& from, double z,
                            const std::function<DrivePath(DrivePath)>& joined, bool last);
  /** The way that was chosen last is driven, or not: then its place may be chosen again. */
  void end(bool drives);

  /** Places that were driven to, or could not be reached. None is looked at twice, nor others
   * within 3 m of it: exploring comes to an end. */
  std::size_t explored() const { return m_seen.size(); }
  /** Whether nothing is left to be looked at around a goal that known ground leads to. */
  bool exhausted() const { return m_exhausted; }

 private:
  using Poses = std::vector<mrpt::math::TPose2D>;

  semantic_planning::SemanticPlanner& m_planner;
  const double m_radius;
  Effort m_effort;
  bool m_wasThere = false, m_exhausted = false;
  std::optional<mrpt::math::TPose2D> m_pose;  ///< where the vehicle was last
  Poses m_seen;                               ///< visited, or not to be reached
  Poses m_tried;                              ///< the same, if the way that was chosen is driven
};

}  // namespace semantic_driving
