#include <gtest/gtest.h>
#include <mrpt/core/Clock.h>
#include <semantic_navigation/Navigator.h>
#include <synthetic_world/Objects.h>
#include <synthetic_world/Sensors.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <utility>
#include <vector>

using mrpt::math::TPose2D;
using semantic_driving::DriveCommand;
using semantic_navigation::Navigator;
using semantic_navigation::NavigatorOptions;
using semantic_navigation::RobotState;
using semantic_slam::SensorScan;
using Status = Navigator::Status;

namespace {

/** Flat grass 40 m wide with a road along x, and a wall beside the road. */
synthetic_world::World plain() {
  synthetic_world::GroundCover cover(20, synthetic_world::kGrass);
  cover.paintBand(synthetic_world::kRoad, {-18, 0}, {18, 0}, 8);
  return synthetic_world::World(synthetic_world::Terrain(20, {}), cover,
                                synthetic_world::wallPanel({-2, 1, 0}, {-2, 6, 0}, 2));
}

NavigatorOptions someOptions(double latency = 0) {
  NavigatorOptions options;
  options.planner.roadmap.vertices = 300;
  options.reactive = std::string(MSO_SOURCE_DIR) + "/config/reactive/robot.ini";
  options.mappingLatency = latency;
  return options;
}

/** A robot that does what it is told at once, and sees with a LiDAR each half a second. */
class Robot {
 public:
  /** \param height of its frame above the ground, m */
  explicit Robot(const NavigatorOptions& options, double height = 0)
      : m_height(height),
        m_mapper(m_map, mapping()),
        navigator(
            m_mapper,
            colored_graph::ClassOrder(synthetic_world::classTable().size() + 1,
                                      {{synthetic_world::kRoad}, {synthetic_world::kGrass}, {0}}),
            options) {
    mrpt::Clock::setActiveClock(mrpt::Clock::Source::Simulated);
    m_robot.drive.pose = {-7, 0, 0};
    update();
  }

  /** Until there is nothing more to do, or for so long. */
  Status drive(double seconds = 60) {
    for (const double end = m_seconds + seconds; m_seconds < end; step())
      if (!navigator.isDriving()) break;
    return navigator.status();
  }
  void step() {
    mrpt::Clock::setSimulatedTime(mrpt::Clock::fromDouble(1e9 + m_seconds));
    if (m_steps++ % 5 == 0) navigator.see(scans(), m_seconds + clockOff + stampsOff);
    if (afterScan) afterScan();
    const DriveCommand c = navigator.step(m_seconds + clockOff);
    commands.push_back({c.speed, c.turn});
    m_robot.drive = {m_robot.drive.pose + TPose2D(0.1 * c.speed, 0, 0.1 * c.turn), c.speed, c.turn};
    m_seconds += 0.1;
    m_driven += 0.1 * std::abs(c.speed);
    update();
  }

  double driven() const { return m_driven; }

  /** As somebody does who walks through it. \return where, map frame */
  std::vector<Eigen::Vector3d> leaveSomething(const std::vector<float>& ahead = {-0.1f, 0.3f}) {
    semantic_types::LabeledCloud cloud;
    for (float z = 0.5f; z < 1; z += 0.1f)
      for (const float x : ahead) cloud.points.emplace_back(x, 0.f, z);
    cloud.classes.assign(cloud.points.size(), synthetic_world::kPerson);
    semantic_octree::InsertionOptions noRays;
    noRays.carvingMargin = 1e3;
    for (int i = 0; i < 5; ++i) m_map.insert(cloud, m_robot.T_odometry_robot, noRays);
    std::vector<Eigen::Vector3d> places;
    for (const Eigen::Vector3f& p : cloud.points)
      places.emplace_back(m_robot.T_odometry_robot * p.cast<double>());
    return places;
  }
  /** How many of these places the map takes for occupied. */
  std::ptrdiff_t countOccupied(const std::vector<Eigen::Vector3d>& places) const {
    return std::count_if(places.begin(), places.end(), [this](const Eigen::Vector3d& p) {
      return m_map.query(p.x(), p.y(), p.z()).status ==
             semantic_octree::CellState::Status::Occupied;
    });
  }

  double seconds() const { return m_seconds; }
  const TPose2D& pose() const { return m_robot.drive.pose; }

  std::function<void()> afterScan;
  int useless = 0;                     ///< points of a scan that take time and tell nothing
  double clockOff = 0, stampsOff = 0;  ///< seconds
  std::vector<std::pair<double, double>> commands;  ///< speed, turn

 private:
  static semantic_slam::MapperOptions mapping() {
    semantic_slam::MapperOptions options;
    options.insertion.minRange = 0.5;
    options.insertion.maxRange = 10;
    return options;
  }
  void update() {
    const TPose2D& p = m_robot.drive.pose;
    m_robot.T_odometry_robot =
        m_world.poseOnGround(p.x, p.y, p.phi) * Eigen::Translation3d(0, 0, m_height);
    navigator.update(m_robot);
  }
  std::vector<SensorScan> scans() const {
    SensorScan scan{{}, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1.4 - m_height))};
    const Eigen::Isometry3d T_world_sensor = m_robot.T_odometry_robot * scan.T_robot_sensor;
    scan.cloud = scanLidar(m_world, T_world_sensor, {24, 180, -45, 10, 20, 0, {}});
    scan.cloud.points.resize(scan.cloud.points.size() + useless, {0.1f, 0, 0});
    scan.cloud.classes.resize(scan.cloud.points.size(), synthetic_world::kRoad);
    return {scan};
  }

  double m_height;
  synthetic_world::World m_world = plain();
  semantic_octree::SemanticOcTree m_map{0.2, synthetic_world::classTable()};
  semantic_slam::Mapper m_mapper;
  RobotState m_robot;
  double m_seconds = 0, m_driven = 0;  // s, m
  int m_steps = 0;

 public:
  Navigator navigator;
};

double distance(const TPose2D& a, const TPose2D& b) { return std::hypot(a.x - b.x, a.y - b.y); }

}  // namespace

TEST(Navigator, StandsWithoutAGoal) {
  Robot robot(someOptions());
  EXPECT_EQ(robot.drive(), Status::Idle);
  for (int i = 0; i < 10; ++i) robot.step();
  for (const auto& [speed, turn] : robot.commands) EXPECT_EQ(speed, 0);
  EXPECT_EQ(robot.navigator.status(), Status::Idle);
  EXPECT_EQ(robot.navigator.reason(), "");
}

TEST(Navigator, DrivesAroundAWallToItsGoalAndTellsTheStagesOfIt) {
  Robot robot(someOptions());
  std::set<std::string> stages;
  robot.navigator.onStage([&](const std::string& stage, double milliseconds) {
    stages.insert(stage);
    EXPECT_GE(milliseconds, 0);
  });
  const TPose2D goal(3, 2, 0);
  robot.navigator.setGoal(goal);
  EXPECT_EQ(robot.drive(), Status::Arrived) << robot.navigator.reason();
  EXPECT_LT(distance(robot.pose(), goal), 0.3);
  EXPECT_EQ(stages,
            (std::set<std::string>{"insert", "movers", "obstacles", "react", "replan", "update"}));
}

TEST(Navigator, DrivesToANewGoalWhenItHasComeToRest) {
  Robot robot(someOptions());
  robot.navigator.setGoal({6, -2, 0});
  EXPECT_EQ(robot.drive(5), Status::Driving);
  EXPECT_GT(robot.navigator.state().speed, 0.3);
  const TPose2D goal(-6, -3, 0);
  robot.navigator.setGoal(goal);
  EXPECT_EQ(robot.drive(2), Status::Driving);
  EXPECT_EQ(robot.drive(), Status::Arrived) << robot.navigator.reason();
  EXPECT_LT(distance(robot.pose(), goal), 0.3);
  for (std::size_t i = 1; i < robot.commands.size(); ++i)
    EXPECT_LT(std::abs(robot.commands[i].first - robot.commands[i - 1].first), 0.1) << i;
}

TEST(Navigator, DrivesAlikeWhereverItsFrameIsOnTheRobot) {
  std::vector<std::pair<double, double>> commands;
  for (const double height : {0.0, 0.3, 1.73}) {
    Robot robot(someOptions(), height);
    EXPECT_FALSE(robot.navigator.frameHeight());
    robot.navigator.setGoal({3, 2, 0});
    EXPECT_EQ(robot.drive(), Status::Arrived) << robot.navigator.reason();
    ASSERT_TRUE(robot.navigator.frameHeight());
    EXPECT_NEAR(*robot.navigator.frameHeight(), height, 0.15);
    if (height == 0) commands = robot.commands;
    EXPECT_TRUE(robot.commands == commands) << height;
  }
}

TEST(Navigator, IsNotHeldByWhatIsLeftInItsOwnPlace) {
  Robot robot(someOptions());
  for (int i = 0; i < 10; ++i) robot.step();
  const auto places = robot.leaveSomething();
  EXPECT_GT(robot.countOccupied(places), 5);
  for (int i = 0; i < 6; ++i) robot.step();  // a scan, whose beams begin above
  EXPECT_EQ(robot.countOccupied(places), 0);
  const TPose2D goal(3, 2, 0);
  robot.navigator.setGoal(goal);
  EXPECT_EQ(robot.drive(), Status::Arrived) << robot.navigator.reason();
  EXPECT_LT(distance(robot.pose(), goal), 0.3);
}

TEST(Navigator, KeepsWhatIsAheadOfItsBumper) {
  NavigatorOptions options = someOptions();
  options.planner.vehicle.footprint = semantic_planning::Footprint::rectangle(-0.5, 1.5, 1.2);
  Robot car(options);
  for (int i = 0; i < 5; ++i) car.step();
  const auto ahead = car.leaveSomething({1.7f}), within = car.leaveSomething();
  car.step();  // a scan
  EXPECT_EQ(car.countOccupied(within), 0);
  EXPECT_EQ(car.countOccupied(ahead), 5);
}

TEST(Navigator, HasAScanInTheMapWhenItsLatencyIsOver) {
  Robot robot(someOptions(0.3));
  robot.navigator.setGoal({3, 0, 0});
  for (int i = 0; i < 40; ++i) {
    const double now = robot.seconds(), newest = 0.5 * std::floor((now - 0.3 + 1e-6) / 0.5);
    robot.step();
    if (newest >= 0) {
      EXPECT_NEAR(robot.navigator.mappedAt(), newest, 1e-6) << now;
    } else {
      EXPECT_LT(robot.navigator.mappedAt(), -1e3) << now;
    }
  }
}

TEST(Navigator, MapsAndDrivesOnWhereItsClockLeapsOrOneStampLies) {
  for (const double leap : {1e6, -1e6}) {
    Robot robot(someOptions(0.3));
    robot.navigator.setGoal({3, 2, 0});
    for (const double seconds : {1.0, 0.4, 4.0}) {  // until its second scan, which lies
      robot.drive(seconds);
      if (robot.stampsOff != 0) robot.clockOff = -leap / 3;
      robot.stampsOff = robot.clockOff == 0 ? leap : 0;
    }
    EXPECT_EQ(robot.drive(), Status::Arrived) << robot.navigator.reason();
    EXPECT_LT(robot.seconds(), 30);
    EXPECT_NEAR(robot.navigator.mappedAt(), robot.seconds(), 1);
  }
}

TEST(Navigator, MapsAndDrivesOnWhereItsClockGoesBackOrItsFirstStampLies) {
  for (const bool isBack : {true, false}) {
    Robot robot(someOptions(0.3));
    robot.navigator.setGoal({3, 2, 0});
    robot.stampsOff = isBack ? 0 : 1e6;
    robot.drive(0.4);
    robot.stampsOff = 0;
    robot.clockOff = isBack ? -30 : 0;
    EXPECT_EQ(robot.drive(), Status::Arrived) << robot.navigator.reason();
    EXPECT_LT(robot.seconds(), 20);
    EXPECT_NEAR(robot.navigator.mappedAt(), robot.seconds(), 1);
  }
}

TEST(Navigator, InsertsPointsThatHaveTimesAsIfTheyHadBeenSeenAtOnce) {
  for (const double latency : {0.0, 0.3}) {
    semantic_octree::SemanticOcTree map(0.2, synthetic_world::classTable());
    semantic_slam::Mapper mapper(map, {});
    Navigator navigator(mapper, colored_graph::ClassOrder(map.numClasses() + 1, {{1}, {0}}),
                        someOptions(latency));
    for (const double seconds : {0.0, 1.0}) {  // at 1 m/s along x
      RobotState robot;
      robot.drive.pose.x = seconds;
      robot.T_odometry_robot = Eigen::Translation3d(seconds, 0, 0);
      navigator.update(robot);
      SensorScan scan{{}, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1.5))};
      scan.cloud.points = {{5, 0.1f, 0}};
      scan.cloud.classes = {synthetic_world::kRoad};
      scan.times = {0.4f};
      navigator.see({scan}, seconds);
      navigator.step(seconds + 0.5);
    }
    using Cell = semantic_octree::CellState::Status;
    EXPECT_EQ(map.query(6.5, 0.1, 1.5).status, Cell::Occupied) << latency;
    EXPECT_EQ(map.query(6.1, 0.1, 1.5).status, Cell::Free) << latency;
  }
}

/** As if the map were not asked while a thread fills it: it may be filled at once, or late. */
TEST(Navigator, DoesWhatItDoesHoweverLongTheMapTakes) {
  Robot quick(someOptions(0.3)), slow(someOptions(0.3));
  quick.afterScan = [&quick] { quick.navigator.mapper(); };  // waits
  slow.useless = 500000;
  for (Robot* robot : {&quick, &slow}) {
    robot->navigator.setGoal({3, 2, 0});
    EXPECT_EQ(robot->drive(), Status::Arrived) << robot->navigator.reason();
  }
  EXPECT_TRUE(quick.commands == slow.commands);
}

TEST(Navigator, LooksAlsoIfItsSensorsSeeNothing) {
  Robot robot(someOptions());
  int looks = 0;
  robot.navigator.onStage([&](const std::string& stage, double) { looks += stage == "replan"; });
  robot.navigator.setGoal({3, 0, 0});
  robot.navigator.see({}, 0);
  robot.navigator.step(0);
  robot.navigator.see({}, 0.5);
  robot.navigator.step(0.5);
  robot.navigator.step(0.6);
  EXPECT_EQ(looks, 2);
}

TEST(Navigator, exploresUntilItIsEnoughAndSaysSo) {
  NavigatorOptions options = someOptions();
  options.explore.sensor = {8, -45, 10, 360};
  options.explore.leftShare = 0.3;
  Robot robot(options);
  tree_abstraction::AbstractionWeights weights;
  weights.terms = {tree_abstraction::relevant("road", 1, {synthetic_world::kRoad})};
  robot.navigator.explore(weights);
  EXPECT_EQ(robot.drive(300), Status::Explored) << robot.navigator.reason();
  EXPECT_GT(robot.driven(), 3);
  EXPECT_NE(robot.navigator.reason().find("left within reach"), std::string::npos);
}

TEST(Navigator, saysWhatIsLeftWhenExploringIsEnded) {
  NavigatorOptions options = someOptions();
  options.explore.sensor = {8, -45, 10, 360};
  Robot robot(options);
  robot.navigator.explore({});
  ASSERT_EQ(robot.drive(3), Status::Driving);
  robot.navigator.endExploring("the time is over");
  EXPECT_EQ(robot.navigator.reason().rfind("the time is over; ", 0), 0U)
      << robot.navigator.reason();
}

TEST(Navigator, exploresNoFartherThanItsBudgetAndThenDrivesToAGoal) {
  NavigatorOptions options = someOptions();
  options.explore.sensor = {8, -45, 10, 360};
  options.explore.budget = 6;
  Robot robot(options);
  robot.navigator.explore({});
  EXPECT_EQ(robot.drive(120), Status::Explored) << robot.navigator.reason();
  EXPECT_LT(robot.driven(), 14);
  EXPECT_NE(robot.navigator.reason().find("budget"), std::string::npos);
  robot.navigator.setGoal({-5, 0, 0});
  EXPECT_EQ(robot.drive(), Status::Arrived) << robot.navigator.reason();
}
