#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <semantic_slam/Mapper.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "Recordings.h"

using namespace recordings;
using semantic_octree::SemanticOcTree;
using semantic_slam::Mapper;
using semantic_slam::MapperOptions;
using semantic_slam::SensorScan;

namespace {

constexpr semantic_types::ClassId kWall = 1, kCar = 2;

semantic_types::ClassTable wallsAndCars() {
  semantic_types::ClassTable table;
  table.add("wall", {200, 100, 60});
  table.add("car", {90, 90, 100});
  table.setHalfLife(kCar, 3);
  return table;
}

Eigen::Isometry3d planar(double x, double y, double heading) {
  return Eigen::Translation3d(x, y, 0) * Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ());
}

/** What is seen of a yard of 12 m x 10 m with walls, frame of the robot. \param carAt a row of cars
 * ahead of the robot, m; 0: none */
LabeledCloud yardFrom(const Eigen::Isometry3d& T_yard_robot, double carAt = 0) {
  LabeledCloud cloud;
  const auto add = [&](double x, double y, double z, semantic_types::ClassId id) {
    cloud.points.push_back((T_yard_robot.inverse() * Eigen::Vector3d(x, y, z)).cast<float>());
    cloud.classes.push_back(id);
  };
  for (double z = 0.1; z < 2; z += 0.2) {
    for (double x = -6; x < 6; x += 0.1)
      for (const double y : {-5., 5.}) add(x, y, z, kWall);
    for (double y = -5; y < 5; y += 0.1)
      for (const double x : {-6., 6.}) add(x, y, z, kWall);
    for (double y = -3; carAt > 0 && y < 3; y += 0.1)
      add(T_yard_robot.translation().x() + carAt, y, z, kCar);
  }
  return cloud;
}

/** A way through the yard, and odometry with noise of it; both begin at its first pose. */
struct Way {
  std::vector<Eigen::Isometry3d> truth, odometry;

  Way(int steps, const Eigen::Isometry3d& T_step, double noise, unsigned seed,
      const Eigen::Isometry3d& begin = planar(-1.5, 0, 0))
      : truth{begin}, odometry{begin} {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    for (int i = 0; i < steps; ++i) {
      truth.push_back(truth.back() * T_step);
      odometry.push_back(odometry.back() * T_step *
                         planar(noise * normal(random), 0, noise / 5 * normal(random)));
    }
  }
  double errorOf(const Eigen::Isometry3d& T_map_odometry, std::size_t i) const {
    return ((T_map_odometry * odometry[i]).translation() - truth[i].translation()).norm();
  }
};

MapperOptions localizing() {
  MapperOptions options;
  options.localize = options.slam.level = true;
  return options;
}

/** Three meters ahead, with scans each half a meter. \return the error at the end */
double errorInYard(Mapper& mapper, const Way& way, double carAt = 0) {
  for (std::size_t i = 0; i < way.truth.size(); ++i)
    mapper.insert(yardFrom(way.truth[i], carAt), Eigen::Isometry3d::Identity(), way.odometry[i], 0);
  return way.errorOf(mapper.T_map_odometry(), way.truth.size() - 1);
}

double errorInYard(const Way& way, double carAt = 0, std::vector<bool> isMover = {}) {
  SemanticOcTree map(0.2, wallsAndCars());
  Mapper mapper(map, localizing());
  mapper.setMovers(std::move(isMover));
  return errorInYard(mapper, way, carAt);
}

const Way kAhead(6, planar(0.5, 0, 0.05), 0.07, 1);

/** A map with one scan of the yard, taken at (1, 1). */
struct YardSeen {
  SemanticOcTree map{0.2, wallsAndCars()};
  Mapper mapper;
  Mapper::Place place;

  explicit YardSeen(bool localize) : mapper(map, optionsFor(localize)) {
    const auto T = planar(1, 1, 0);
    place = mapper.insert(yardFrom(T), Eigen::Isometry3d::Identity(), T, 0).place;
  }

 private:
  static MapperOptions optionsFor(bool localize) {
    MapperOptions options = localizing();
    options.localize = localize;
    return options;
  }
};

}  // namespace

RC_GTEST_PROP(Mapper, withoutLocalizationIsInsertionToTheLastBit, ()) {
  SemanticOcTree direct(0.2, wallsAndCars()), map(0.2, wallsAndCars());
  MapperOptions options;
  options.insertion.maxRange = 7;
  Mapper mapper(map, options);
  double seconds = 100;
  for (int i = *rc::gen::inRange(1, 6); i > 0; --i) {
    const auto number = [] { return *rc::gen::inRange(-100, 100) * 0.013; };
    const Eigen::Isometry3d T_map_robot = planar(number(), number(), number());
    const Eigen::Isometry3d T_robot_sensor = planar(number(), 0, number());
    const LabeledCloud cloud = yardFrom(T_map_robot * T_robot_sensor, 2);
    const double since = *rc::gen::inRange(0, 40) * 0.1;
    seconds += since;
    direct.insert(cloud, T_map_robot * T_robot_sensor, options.insertion,
                  direct.empty() ? 0 : since);
    mapper.insert(cloud, T_robot_sensor, T_map_robot, seconds);
    RC_ASSERT(mapper.T_map_odometry().matrix() == Eigen::Matrix4d::Identity());
  }
  RC_ASSERT(map == direct);
  RC_ASSERT(map.clock() == direct.clock());
}

TEST(Mapper, agesByTheTimeBetweenScansHoweverOftenItIsTold) {
  SemanticOcTree once(0.2, wallsAndCars()), often(0.2, wallsAndCars());
  Mapper a(once, {}), b(often, {});
  for (int i = 0; i < 4; ++i) {
    const auto T = planar(0.3 * i, 0, 0);
    a.insert(yardFrom(T, 2), Eigen::Isometry3d::Identity(), T, 1e9 + 0.7 * i);
    b.age(1e9 + 0.7 * i - 0.3);
    b.age(1e9 + 0.7 * i - 0.1);
    b.insert(yardFrom(T, 2), Eigen::Isometry3d::Identity(), T, 1e9 + 0.7 * i);
  }
  EXPECT_NEAR(once.clock(), 2.1, 1e-6);
  EXPECT_NEAR(often.clock(), 2.4, 1e-6) << "told first 0.3 s before the first scan";
}

TEST(Mapper, goesOnWhereAClockThatBeganIn1970IsSet) {
  SemanticOcTree map(0.2, wallsAndCars());
  Mapper mapper(map, {});
  const auto T = planar(0, 0, 0);
  for (const double seconds : {12.0, 1.8e9, 1.8e9 + 1})
    mapper.insert(yardFrom(T, 2), Eigen::Isometry3d::Identity(), T, seconds);
  EXPECT_NEAR(map.clock(), 1e9 + 1, 1e-3);
}

TEST(Mapper, statesWhatLabelsOfFourScansAreWorthFromEightOnAndOfAllAtTheEnd) {
  for (const bool localize : {false, true}) {
    SemanticOcTree map(0.2, wallsAndCars()), byHand(0.2, wallsAndCars());
    semantic_octree::Calibrator calibrator(0.2, 2);
    std::vector<semantic_octree::Calibration> fits;
    MapperOptions options = localizing();
    options.localize = localize;
    Mapper mapper(map, options);
    std::mt19937 random(2);
    for (int i = 0; i < 9; ++i) {
      EXPECT_EQ(map.filterParameters().calibration.isIdentity(), i < 8);
      const auto T = planar(0.1 * i, 0, 0);
      LabeledCloud cloud = yardFrom(T);
      for (std::size_t first = 0; first < cloud.size(); first += 20)  // wrong as a whole
        if (random() % 10 < 3)
          std::fill_n(cloud.classes.begin() + static_cast<std::ptrdiff_t>(first),
                      std::min<std::size_t>(20, cloud.size() - first), kCar);
      mapper.insert(cloud, Eigen::Isometry3d::Identity(), T, 0);
      byHand.insert(cloud, T);
      calibrator.add(cloud, T);
      if (i == 3 || i == 7) byHand.setCalibration(fits.emplace_back(calibrator.fit(byHand)));
    }
    const auto valuesOf = [](const semantic_octree::Calibration& calibration) {
      return std::pair(calibration.power, calibration.shared);
    };
    const auto afterEight = valuesOf(map.filterParameters().calibration);
    EXPECT_LT(afterEight.first, 0.8);
    mapper.finish();
    const auto atEnd = valuesOf(map.filterParameters().calibration);
    EXPECT_NE(atEnd, afterEight);
    EXPECT_LT(atEnd.first, 0.8);
    if (localize) continue;
    EXPECT_EQ(afterEight, valuesOf(fits[0]));
    EXPECT_EQ(atEnd, valuesOf(calibrator.fit(byHand)));
  }
}

TEST(Mapper, scansCorrectWhatOdometryMeasuredBadly) {
  double odometry = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Way way(6, planar(0.5, 0, 0.05), 0.07, seed);
    EXPECT_LT(errorInYard(way), 0.03) << seed;
    odometry += way.errorOf(Eigen::Isometry3d::Identity(), 6) / 10;
  }
  EXPECT_GT(odometry, 0.1);
}

TEST(Mapper, whatMovesIsNoEvidence) {
  std::vector<bool> isMover(256, false);
  const double still = errorInYard(kAhead, 0, isMover);
  EXPECT_NE(still, errorInYard(kAhead, 3, isMover));
  isMover[kCar] = true;
  EXPECT_EQ(still, errorInYard(kAhead, 3, isMover));
}

TEST(Mapper, beamsWithoutAReturnAreNoEvidence) {
  const auto endWith = [](std::size_t beams) {
    SemanticOcTree map(0.2, wallsAndCars());
    Mapper mapper(map, localizing());
    for (std::size_t i = 0; i < kAhead.truth.size(); ++i) {
      SensorScan scan{yardFrom(kAhead.truth[i]), Eigen::Isometry3d::Identity(), 15};
      for (std::size_t b = 0; b < beams; ++b) {
        const double angle = 2 * M_PI * double(b) / double(beams);
        scan.cloud.points.emplace_back(15.1 * std::cos(angle), 15.1 * std::sin(angle), 0.5);
        scan.cloud.classes.push_back(semantic_types::kNoClass);
      }
      mapper.insert({scan}, mapper.locate({scan}, kAhead.odometry[i]), 0);
    }
    return mapper.T_map_odometry().matrix();
  };
  EXPECT_EQ(endWith(5000), endWith(0));
}

TEST(Mapper, closesLoopsAndItsMapIsTheOneOfTheCorrectedPosesToTheLastBit) {
  const Recording r = recordingOf("park", 1, lidarOf(0.1));
  MapperOptions options;
  options.localize = true;
  options.insertion.maxRange = 20;
  SemanticOcTree map(0.4, synthetic_world::classTable()), anew(0.4, synthetic_world::classTable());
  Mapper mapper(map, options);
  bool moved = false;
  std::vector<Slam::Added> added;
  for (std::size_t i = 0; i < r.clouds.size(); ++i) {
    added.push_back(*mapper.insert(r.clouds[i], kRobotLidar, r.odometry[i], 0).place.added);
    moved = moved || added.back().posesMoved;
  }
  EXPECT_TRUE(moved);
  EXPECT_GT((r.odometry.back().translation() - r.truth.back().translation()).norm(), 3);
  const Eigen::Isometry3d T_map_robot = mapper.T_map_odometry() * r.odometry.back();
  EXPECT_LT((T_map_robot.translation() - r.truth.back().translation()).norm(), 0.3);
  mapper.finish();
  for (std::size_t i = 0; i < r.clouds.size(); ++i)
    anew.insert(
        r.clouds[i],
        mapper.slam()->poses()[added[i].keyframe] * (added[i].T_keyframe_robot * kRobotLidar),
        options.insertion);
  EXPECT_TRUE(map == anew);
}

TEST(Mapper, insertsEachNthScanWhereNoKeyframeBegins) {
  SemanticOcTree map(0.2, wallsAndCars());
  MapperOptions options = localizing();
  options.insertEvery = 3;
  Mapper mapper(map, options);
  std::string inserted;
  for (const double x : {0., 0., 0., 0., 0., 1.2, 1.2, 1.2, 1.2}) {
    const auto T = planar(x, 0, 0);
    const auto report = mapper.insert(yardFrom(T), Eigen::Isometry3d::Identity(), T, 0);
    inserted += report.scans.empty() ? '.' : 'x';
  }
  EXPECT_EQ(inserted, "x..x.x..x");
}

TEST(Mapper, aMapWithContentIsTheFrameAndIsNotMoved) {
  SemanticOcTree map(0.2, wallsAndCars());
  const Eigen::Isometry3d T_map_yard = planar(0.4, -0.2, 0.03);
  map.insert(yardFrom(planar(0, 0, 0)), T_map_yard);
  Mapper mapper(map, localizing());
  errorInYard(mapper, Way(6, planar(0.5, 0, 0.05), 0, 1));
  EXPECT_TRUE(mapper.T_map_odometry().isApprox(T_map_yard, 0.05))
      << mapper.T_map_odometry().matrix();
}

TEST(Mapper, isFoundAgainWhereAPersonSaysThatItIs) {
  SemanticOcTree map(0.2, wallsAndCars());
  Mapper mapper(map, localizing());
  const auto see = [&](const Eigen::Isometry3d& T_yard_robot) {
    return mapper.insert(yardFrom(T_yard_robot), Eigen::Isometry3d::Identity(), planar(0, 0, 0), 0)
        .place.T_map_robot;
  };
  const auto T_map_yard = planar(0.1, 0.1, 0), T_begin = planar(-2, 1, 0.2);
  mapper.relocalize(T_map_yard * T_begin);  // before the first scan, odometry begins there
  EXPECT_LT((see(T_begin).translation() - (T_map_yard * T_begin).translation()).norm(), 1e-9);
  const SemanticOcTree before(map);
  const auto T_carried = planar(2, -1.5, 1);
  mapper.relocalize(T_map_yard * planar(2.3, -1.7, 0.9));
  EXPECT_TRUE(map == before);
  const auto T = see(T_carried), off = (T_map_yard * T_carried).inverse() * T;
  EXPECT_LT(off.translation().norm(), 0.05);
  EXPECT_LT(Eigen::AngleAxisd(off.linear()).angle(), 0.01);
  EXPECT_LT((mapper.T_map_odometry().translation() - T.translation()).norm(), 1e-9);
  SemanticOcTree other(0.2, wallsAndCars());
  EXPECT_THROW(Mapper(other, {}).relocalize(T), std::logic_error);
}

TEST(Mapper, whoDrivesInCirclesKeepsTheFirstAndTheLastLooksWhoseMapItHasToTheLastBit) {
  const Way circles(139, planar(0.4, 0, 0.5), 0.03, 1, planar(0, -0.8, 0));
  SemanticOcTree map(0.2, wallsAndCars()), anew(0.2, wallsAndCars());
  MapperOptions options = localizing();
  options.forgetsFrom = 64;
  Mapper mapper(map, options);
  std::vector<LabeledCloud> kept;
  double off = 0;
  for (std::size_t i = 0; i < circles.truth.size(); ++i) {
    const std::vector<SensorScan> seen{{yardFrom(circles.truth[i])}};
    const auto place = mapper.locate(seen, circles.odometry[i]);
    kept.push_back(seen[0].cloud);
    const auto before = mapper.slam()->poses();
    mapper.insert(seen, place, 0);
    const auto& poses = mapper.slam()->poses();
    std::vector<LabeledCloud> left;
    for (std::size_t k = 0; k < before.size() && left.size() < poses.size(); ++k)
      if (before[k].matrix() == poses[left.size()].matrix()) left.push_back(kept[k]);
    ASSERT_EQ(left.size(), poses.size()) << "poses stay";
    kept = left;
    off = std::max(off, circles.errorOf(mapper.T_map_odometry(), i));
  }
  EXPECT_LT(kept.size(), 110u);
  EXPECT_LT(off, 0.05);
  mapper.finish();
  for (std::size_t k = 0; k < kept.size(); ++k)
    anew.insert(kept[k], mapper.slam()->poses()[k], options.insertion);
  anew.setCalibration(map.filterParameters().calibration);
  EXPECT_TRUE(map == anew);
  for (const auto& edge : mapper.slam()->edges()) EXPECT_LT(std::max(edge.a, edge.b), kept.size());
}

TEST(Mapper, whatTheRobotStandsOnCarvesNothing) {
  for (const bool localize : {false, true}) {
    YardSeen yard(localize);
    yard.mapper.insertBelow({{{0.5f, 0, -2}}, {kCar}, {}}, yard.place);
    EXPECT_EQ(yard.map.query(1.5, 1, -2).likeliestClass, kCar);
    EXPECT_EQ(yard.map.query(1.25, 1, -1).status, semantic_octree::CellState::Status::Unknown);
  }
}

TEST(Mapper, whatIsKnownToBeFreeIsFreeAfterSomeTimesAndNothingElseChanges) {
  for (const bool localize : {false, true}) {
    YardSeen yard(localize);
    for (int i = 0; i < 5; ++i) yard.mapper.insertBelow({{{0.5f, 0, 1}}, {kCar}, {}}, yard.place);
    const SemanticOcTree before = yard.map;
    for (int i = 0; i < 10; ++i) yard.mapper.insertFree({0.5, 0, 1}, 0.3, yard.place);
    EXPECT_EQ(yard.map.query(1.5, 1, 1).status, semantic_octree::CellState::Status::Free);
    for (const double x : {1.0, 2.0})
      EXPECT_EQ(yard.map.query(x, 1, 1).occupancy, before.query(x, 1, 1).occupancy) << x;
  }
}
