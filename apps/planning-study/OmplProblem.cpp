#include "OmplProblem.h"

#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/spaces/ReedsSheppStateSpace.h>
#include <ompl/geometric/PathGeometric.h>

#include <array>
#include <map>
#include <mutex>
#include <tuple>

#include "RoadmapSearch.h"

namespace planning_study {

namespace ob = ompl::base;
using colored_graph::EdgeProfile;
using colored_graph::Length;
using mrpt::math::TPose2D;
using namespace semantic_planning;

namespace {

TPose2D poseOf(const ob::State* state) {
  const auto* s = state->as<ob::SE2StateSpace::StateType>();
  return {s->getX(), s->getY(), s->getYaw()};
}

bool isBefore(const TPose2D& a, const TPose2D& b) {
  return std::tie(a.x, a.y, a.phi) < std::tie(b.x, b.y, b.phi);
}

/** Measures as quickly as our planner does: OMPL's own solver would cost the peers most of their
 * time. */
class Poses : public ob::ReedsSheppStateSpace {
 public:
  explicit Poses(double turningRadius)
      : ReedsSheppStateSpace(turningRadius), m_reedsShepp(turningRadius) {}
  double distance(const ob::State* a, const ob::State* b) const override {
    return m_reedsShepp.distance(poseOf(a), poseOf(b));
  }

 private:
  ReedsShepp m_reedsShepp;
};

}  // namespace

/** Locks, since OMPL's PRM* looks for solutions in a thread of its own. Remembers all motions: OMPL
 * asks for the validity of one, then for its cost, and for that again with every path it finds. */
class MotionOracle {
 public:
  explicit MotionOracle(const SemanticPlanner& planner)
      : m_checker(planner.ground(), planner.options().vehicle, planner.order(),
                  planner.options().reading) {}

  bool isValid(const TPose2D& pose) {
    const std::lock_guard<std::mutex> lock(m_mutex);
    return isFree(m_checker, pose);
  }
  /** In the canonical direction, as a roadmap's edges. */
  std::optional<EdgeProfile> profile(TPose2D a, TPose2D b) {
    const std::lock_guard<std::mutex> lock(m_mutex);
    if (isBefore(b, a)) std::swap(a, b);
    const auto [known, isNew] = m_known.try_emplace({a.x, a.y, a.phi, b.x, b.y, b.phi});
    if (isNew) {
      const auto from = m_checker.place(a), to = m_checker.place(b);
      if (from && to) known->second = m_checker.profile(*from, *to);
    }
    return known->second;
  }
  std::optional<Length> cost(const TPose2D& a, const TPose2D& b) {
    const auto edge = profile(a, b);
    return edge ? weighted(*edge, m_checker.order()) : std::nullopt;
  }
  int classes() const { return m_checker.order().classes(); }
  std::size_t checked() const { return m_known.size(); }

 private:
  std::mutex m_mutex;
  CollisionChecker m_checker;
  std::map<std::array<double, 6>, std::optional<EdgeProfile>> m_known;
};

namespace {

class PoseValidity : public ob::StateValidityChecker {
 public:
  PoseValidity(const ob::SpaceInformationPtr& space, MotionOracle& oracle)
      : StateValidityChecker(space), m_oracle(oracle) {}
  bool isValid(const ob::State* state) const override { return m_oracle.isValid(poseOf(state)); }

 private:
  MotionOracle& m_oracle;
};

class CurveValidity : public ob::MotionValidator {
 public:
  CurveValidity(const ob::SpaceInformationPtr& space, MotionOracle& oracle)
      : MotionValidator(space), m_oracle(oracle) {}
  bool checkMotion(const ob::State* a, const ob::State* b) const override {
    return m_oracle.cost(poseOf(a), poseOf(b)).has_value();
  }
  bool checkMotion(const ob::State* a, const ob::State* b,
                   std::pair<ob::State*, double>& lastValid) const override {
    if (checkMotion(a, b)) return true;
    if (lastValid.first) si_->copyState(lastValid.first, a);
    lastValid.second = 0;
    return false;
  }

 private:
  MotionOracle& m_oracle;
};

/** Integral of 10^rank along the motion, meters. Blocked motions have a finite cost, too: lazy
 * planners search over them before they check them. */
class ClassIntegral : public ob::OptimizationObjective {
 public:
  ClassIntegral(const ob::SpaceInformationPtr& space, MotionOracle& oracle)
      : OptimizationObjective(space), m_oracle(oracle) {
    description_ = "integral of class weights";
    setCostThreshold(ob::Cost(0));  // go on until time is over
    // Without, BIT* draws no state that is nearer to the start than the goal is.
    setCostToGoHeuristic(ob::goalRegionCostToGo);
  }
  ob::Cost stateCost(const ob::State*) const override { return identityCost(); }
  ob::Cost motionCost(const ob::State* a, const ob::State* b) const override {
    const auto cost = m_oracle.cost(poseOf(a), poseOf(b));
    return cost ? ob::Cost(colored_graph::toMeters(*cost)) : motionCostHeuristic(a, b);
  }
  ob::Cost motionCostHeuristic(const ob::State* a, const ob::State* b) const override {
    return ob::Cost(si_->distance(a, b));
  }
  bool isSymmetric() const override { return true; }

 private:
  MotionOracle& m_oracle;
};

ob::RealVectorBounds boundsOf(const Instance& instance, double buffer) {
  const TPose2D &a = instance.start, &b = instance.goal;
  ob::RealVectorBounds bounds(2);
  bounds.setLow(0, std::min(a.x, b.x) - buffer);
  bounds.setLow(1, std::min(a.y, b.y) - buffer);
  bounds.setHigh(0, std::max(a.x, b.x) + buffer);
  bounds.setHigh(1, std::max(a.y, b.y) + buffer);
  return bounds;
}

void setPose(const TPose2D& pose, ob::ScopedState<ob::SE2StateSpace>& state) {
  state->setXY(pose.x, pose.y);
  state->setYaw(pose.phi);
}

}  // namespace

OmplProblem::OmplProblem(const SemanticPlanner& planner, const Instance& instance)
    : oracle(std::make_shared<MotionOracle>(planner)) {
  const PlannerOptions& options = planner.options();
  auto poses = std::make_shared<Poses>(options.vehicle.turningRadius);
  poses->setBounds(boundsOf(instance, options.roadmap.buffer));
  space = std::make_shared<ob::SpaceInformation>(poses);
  space->setStateValidityChecker(std::make_shared<PoseValidity>(space, *oracle));
  space->setMotionValidator(std::make_shared<CurveValidity>(space, *oracle));
  space->setup();
  definition = std::make_shared<ob::ProblemDefinition>(space);
  ob::ScopedState<ob::SE2StateSpace> start(poses), goal(poses);
  setPose(instance.start, start);
  setPose(instance.goal, goal);
  definition->setStartAndGoalStates(start, goal);
  definition->setOptimizationObjective(std::make_shared<ClassIntegral>(space, *oracle));
}

std::vector<Length> OmplProblem::lengthPerClass() const {
  std::vector<Length> lengths(oracle->classes());
  const auto& path = *definition->getSolutionPath()->as<ompl::geometric::PathGeometric>();
  for (std::size_t i = 1; i < path.getStateCount(); ++i) {
    const auto motion = oracle->profile(poseOf(path.getState(i - 1)), poseOf(path.getState(i)));
    for (const auto& s : motion.value()) lengths[s.classId] += s.length;
  }
  return lengths;
}

std::size_t OmplProblem::motionsChecked() const { return oracle->checked(); }

}  // namespace planning_study
