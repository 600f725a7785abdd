#include "ExploreTrial.h"

#include <semantic_driving/PathCheck.h>
#include <strict_files/TextFile.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "KnownShare.h"
#include "simulated_drive/DriveLoop.h"

namespace drive_study {

using mrpt::math::TPose2D;
using semantic_driving::DrivePath;
using semantic_driving::ExploreOptions;
using semantic_driving::View;
using semantic_driving::ViewStrategy;
using semantic_octree::SemanticOcTree;
using semantic_planning::SemanticPlanner;
using synthetic_world::World;

namespace {

/** A planner whose graph needs no compressed tree. */
semantic_planning::PlannerOptions plannerOf(const simulated_drive::DriveConfig& config) {
  semantic_planning::PlannerOptions options = config.planner;
  options.roadmap.kind = semantic_planning::GraphKind::HaltonDrivable;
  return options;
}

class Glide {
 public:
  Glide(const simulated_drive::DriveConfig& config, const synthetic_world::Scene& scene,
        const colored_graph::ClassOrder& order, const ExploreTask& task, Exploring how)
      : m_config(config),
        m_world(scene.world),
        m_task(task),
        m_map(config.voxelSize, synthetic_world::classTable(), config.filter),
        m_planner(m_map, order, plannerOf(config)),
        m_check(m_planner),
        m_sensors(config.sensors, false),
        m_known(m_map, m_world, task),
        m_strategy(strategyFor(how)),
        m_footprint(simulated_drive::trueFootprint(config.planner.vehicle)) {}

  ExploreTrial run(const TPose2D& start) {
    m_trial.start = start;
    place(start);
    standOnGround();
    for (int i = 0; i < 4; ++i) place({start.x, start.y, start.phi + i * M_PI / 2}), look();
    place(start);
    while (m_meters < m_config.explore.budget) {
      const auto view = m_strategy->next(m_pose, z());
      if (!view) return over(m_strategy->conclusion());
      goTo(*view);
      if (m_unreachedInARow > kMostUnreached) return over("no view can be reached any more");
    }
    return over("the budget is driven");
  }

 private:
  static constexpr int kMostUnreached = 30;

  std::unique_ptr<ViewStrategy> strategyFor(Exploring how) {
    constexpr double kRim = 1;  // m
    ExploreOptions options = m_config.explore;
    const Eigen::Vector2d far = Eigen::Vector2d::Constant(m_task.within - kRim);
    options.area = {-far, far};
    if (how == Exploring::Frontier) return semantic_driving::nearestFrontier(m_planner, options);
    const bool plain = how == Exploring::Plain;
    tree_abstraction::AbstractionWeights weights = m_task.weights;
    if (plain) weights.terms = {tree_abstraction::wholeClassVariable("all", 1, m_map.numClasses())};
    return semantic_driving::relevantViews(m_planner, m_map, weights, options, !plain);
  }
  ExploreTrial over(const std::string& why) {
    m_trial.end = why;
    return m_trial;
  }

  double z() const { return m_world.groundHeight(m_pose.x, m_pose.y); }
  Eigen::Isometry3d T_world_robot() const {
    return m_world.poseOnGround(m_pose.x, m_pose.y, m_pose.phi);
  }
  void place(const TPose2D& pose) {
    m_pose = pose;
    m_trial.track.push_back(pose);
  }

  /** The robot knows the ground below it where it begins. */
  void standOnGround() {
    constexpr double kAround = 1.2;  // m
    semantic_types::LabeledCloud cloud;
    for (double x = -kAround; x < kAround; x += 0.1)
      for (double y = -kAround; y < kAround; y += 0.1) {
        const double wx = m_pose.x + x, wy = m_pose.y + y;
        cloud.points.emplace_back(x, y, m_world.groundHeight(wx, wy) - z() - 1.001);
        cloud.classes.push_back(m_world.groundClass(wx, wy));
      }
    m_map.insert(cloud, Eigen::Isometry3d(Eigen::Translation3d(m_pose.x, m_pose.y, z() + 1)));
    m_planner.update();
  }

  void look() {
    for (const auto& seen : m_sensors.sense(m_world, T_world_robot())) {
      semantic_octree::InsertionOptions options = m_config.insertion;
      if (m_config.sensors.emptyCarves)
        options.maxRange =
            std::min(options.maxRange > 0 ? options.maxRange : HUGE_VAL, seen.emptyFrom);
      m_map.insert(seen.cloud, T_world_robot() * seen.T_robot_sensor, options);
    }
    m_planner.update();
    m_lookedAt = m_meters;
    m_trial.known.push_back({m_meters, m_known.share()});
  }

  void goTo(const View& view) {
    const auto plan = m_planner.plan(m_pose, view.pose, z(), view.z);
    if (plan.found()) {
      m_unreachedInARow = 0;
      return glide(DrivePath(plan.path), view);
    }
    ++m_unreachedInARow;
    if (m_planner.check(m_pose, z()) == semantic_planning::PlanStatus::Found)
      return m_strategy->done(view);
    goBack();
  }

  /** A part of the way, until it is time to choose again, or the way is not free. */
  void glide(const DrivePath& path, const View& view) {
    constexpr double kStep = 0.2, kBetweenLooks = 1, kBetweenChoices = 5;  // m
    bool isFirst = true;
    for (double s = 0; s < path.length() && s < kBetweenChoices;) {
      const double step = std::min(kStep, path.length() - s);
      s += step;
      move(semantic_driving::poseOf(path.at(s)), step);
      if (m_meters - m_lookedAt < kBetweenLooks) continue;
      std::exchange(isFirst, false) ? lookAsPromised() : look();
      if (!m_check.judge(path, s).isFree()) return;
    }
    if (path.length() > kBetweenChoices) return;
    look();
    m_strategy->done(view);
  }

  /** The first look after a choice: the map is as it was promised by. */
  void lookAsPromised() {
    const double promised = m_strategy->promise(m_pose, z());
    const long before = m_known.columns();
    look();
    const long came = m_known.columns() - before;
    m_trial.promises.push_back({promised, static_cast<double>(came)});
  }

  /** From where it must not be, along its track. */
  void goBack() {
    constexpr std::size_t kSteps = 5;
    std::vector<TPose2D> track = m_trial.track;
    for (std::size_t i = 2; i < 2 + kSteps && i <= track.size(); ++i) {
      const TPose2D& pose = track[track.size() - i];
      move(pose, std::hypot(pose.x - m_pose.x, pose.y - m_pose.y));
      m_trial.track.resize(m_trial.track.size() - 2);
    }
    look();
  }

  void move(const TPose2D& pose, double way) {
    m_meters += way;
    place(pose);
    m_trial.collisions += !m_world.isFree(m_footprint, pose.x, pose.y, pose.phi);
  }

  const simulated_drive::DriveConfig& m_config;
  const World& m_world;
  const ExploreTask& m_task;
  SemanticOcTree m_map;
  SemanticPlanner m_planner;
  semantic_driving::PathCheck m_check;
  simulated_drive::SimulatedSensors m_sensors;
  KnownShare m_known;
  std::unique_ptr<ViewStrategy> m_strategy;
  synthetic_world::Footprint m_footprint;
  ExploreTrial m_trial;
  TPose2D m_pose;
  double m_meters = 0, m_lookedAt = 0;
  int m_unreachedInARow = 0;
};

}  // namespace

double ExploreTrial::metersTo(double share) const {
  for (const KnownAfter& k : known)
    if (k.share >= share) return k.meters;
  return std::numeric_limits<double>::infinity();
}

namespace {

/** Equal values have the mean of their ranks. */
std::vector<double> ranksOf(const std::vector<double>& values) {
  std::vector<double> sorted = values, ranks;
  std::sort(sorted.begin(), sorted.end());
  for (const double value : values) {
    const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), value);
    ranks.push_back(static_cast<double>((first - sorted.begin()) + (last - sorted.begin())) / 2);
  }
  return ranks;
}

double correlationOf(const std::vector<double>& a, const std::vector<double>& b) {
  const double middle = static_cast<double>(a.size()) / 2;
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double x = a[i] - middle, y = b[i] - middle;
    ab += x * y, aa += x * x, bb += y * y;
  }
  return ab / std::sqrt(aa * bb);
}

}  // namespace

double ExploreTrial::promiseAgainstWhatCame() const {
  std::vector<double> promised, came;
  for (const KeptPromise& p : promises) promised.push_back(p.promised), came.push_back(p.came);
  return correlationOf(ranksOf(promised), ranksOf(came));
}

ExploreTrial explore(const simulated_drive::DriveConfig& config,
                     const synthetic_world::Scene& scene, const colored_graph::ClassOrder& order,
                     const ExploreTask& task, const TPose2D& start, Exploring how) {
  ExploreTrial trial = Glide(config, scene, order, task, how).run(start);
  trial.how = how;
  return trial;
}

std::string toCsv(const std::vector<ExploreTrial>& trials) {
  std::ostringstream out;
  out << "scene,number,strategy,meters,known,end\n";
  for (const ExploreTrial& t : trials)
    for (const KnownAfter& k : t.known)
      out << t.scene << ',' << t.number << ',' << strict_files::nameIn(choicesOf(t.how), t.how)
          << ',' << k.meters << ',' << k.share << ',' << strict_files::csvField(t.end) << '\n';
  return out.str();
}

}  // namespace drive_study
