#pragma once
#include <mrpt/math/TPose2D.h>
#include <ompl/base/spaces/DubinsStateSpace.h>
#include <ompl/base/spaces/ReedsSheppStateSpace.h>

/** OMPL's distances of Reeds and Shepp, and of Dubins, from another implementation than ours. */
class ReedsSheppOracle {
 public:
  explicit ReedsSheppOracle(double turningRadius)
      : m_radius(turningRadius),
        m_space(turningRadius),
        m_dubins(turningRadius),
        m_a(state()),
        m_b(state()) {}
  ~ReedsSheppOracle() {
    m_space.freeState(m_a);
    m_space.freeState(m_b);
  }
  ReedsSheppOracle(const ReedsSheppOracle&) = delete;
  ReedsSheppOracle& operator=(const ReedsSheppOracle&) = delete;

  double distance(const mrpt::math::TPose2D& a, const mrpt::math::TPose2D& b) const {
    set(m_a, a);
    set(m_b, b);
    return m_radius * m_space.reedsShepp(m_a, m_b).length();
  }
  double forwardDistance(const mrpt::math::TPose2D& a, const mrpt::math::TPose2D& b) const {
    set(m_a, a);
    set(m_b, b);
    return m_radius * m_dubins.dubins(m_a, m_b).length();
  }

 private:
  using Space = ompl::base::ReedsSheppStateSpace;

  Space::StateType* state() { return m_space.allocState()->as<Space::StateType>(); }
  static void set(Space::StateType* state, const mrpt::math::TPose2D& pose) {
    state->setXY(pose.x, pose.y);
    state->setYaw(pose.phi);
  }

  double m_radius;
  Space m_space;
  ompl::base::DubinsStateSpace m_dubins;
  Space::StateType *m_a, *m_b;
};
