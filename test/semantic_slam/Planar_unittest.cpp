// A laser scanner in the plane: x, y and heading, of a world that is known.
#include <gtest/gtest.h>
#include <semantic_slam/Registration.h>
#include <semantic_slam/Slam.h>

#include <cmath>
#include <random>

#include "Recordings.h"
#include "TemporaryFolder.h"

using namespace recordings;
using semantic_octree::SemanticOcTree;

namespace {

constexpr double kFlat = 0;
constexpr double kWhole = 1e9, kDriven = 90;  // m

/** A map of the flat village. \param voxelSize meters */
SemanticOcTree mapOf(double voxelSize, const Sensor& sensor,
                     const Eigen::Isometry3d& T_robot_sensor) {
  return recordings::mapOf("village", 3, {sensor, T_robot_sensor, 100, voxelSize, kFlat, 2});
}

/** 1 m and 4 degrees beside where it began. */
void moveOdometry(Recording& r) {
  Vector6 off;
  off << 0.8, -0.6, 0, 0, 0, 4 * M_PI / 180;
  recordings::moveOdometry(r, off);
}

/** Along x from 0 to 1 m at y = 0.5 m, eight points 0.125 m apart, off by 0.02 m to either side.
 * \param climb height per meter */
LabeledCloud wall(float climb) {
  LabeledCloud cloud;
  for (int i = 0; i < 8; ++i) {
    const float x = 0.0625f + 0.125f * static_cast<float>(i), side = (i + 1) / 2 % 2 ? -1 : 1;
    cloud.points.emplace_back(x, 0.5f + 0.02f * side, 0.15f + climb * x);
  }
  return cloud;
}

std::string warningsOf(const Slam& slam) {
  std::string all;
  for (const std::string& warning : slam.report().warnings()) all += warning + "\n";
  return all;
}

/** What the program says in the end. */
std::string warningsOf(const Recording& r) {
  Slam slam({});
  for (std::size_t i = 0; i < r.clouds.size(); ++i)
    slam.add(r.clouds[i], kRobotLaser, r.odometry[i]);
  slam.finish();
  return warningsOf(slam);
}

/** Streets around a block, 300 x 20 m in their middle, for a scanner that sees 10 m. The first one
 * has bare walls, all others have niches. */
class Block {
 public:
  Block() {
    addWalls(2, 298, 0, 16);
    addWalls(-2, 302, -2, 24);
    for (double x = -1; x < 301; x += apart()) addNiche(x, 21.9);
    for (double x = -1; x < 9; x += apart() / 2) addNiche(x, -2);
    for (double y = 0; y < 20; y += apart()) addNiche(-2, y), addNiche(301.5, y);
  }
  /** Instead a hall, 6 m wide and longer than it sees, with equal pillars along its walls.
   * \param apart m */
  explicit Block(double apart) {
    addWalls(-100, 200, -3, 3);
    for (double x = -50; x < 150; x += apart)
      for (const double y : {-3., 2.6}) addWalls(x, x + 0.4, y, y + 0.4);
  }
  LabeledCloud seenAt(const Eigen::Isometry3d& T_world_robot) {
    LabeledCloud cloud;
    for (int degrees = 0; degrees < 360; ++degrees) {
      const Eigen::Vector3d beam = turned(degrees * M_PI / 180) * Eigen::Vector3d::UnitX();
      const double range = rangeOf(T_world_robot.translation(), T_world_robot.linear() * beam) +
                           0.06 * (share(m_random) - 0.5);
      if (range < 10) cloud.points.push_back((range * beam).cast<float>());
    }
    return cloud;
  }
  static Eigen::Isometry3d turned(double heading) {
    return Eigen::Isometry3d(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()));
  }

 private:
  static double share(std::mt19937& random) { return random() / 4294967296.0; }
  double apart() { return 1 + 5 * share(m_random); }  // m
  void addNiche(double x, double y) {
    const double size = 0.3 + 0.5 * share(m_random);
    addWalls(x, x + size, y, y + size);
  }
  void addWalls(double x0, double x1, double y0, double y1) {
    m_walls.insert(m_walls.end(),
                   {{x0, y0, x1, y0}, {x1, y0, x1, y1}, {x1, y1, x0, y1}, {x0, y1, x0, y0}});
  }
  double rangeOf(const Eigen::Vector3d& from, const Eigen::Vector3d& beam) const {
    const auto cross = [](const auto& a, const auto& b) { return a.x() * b.y() - a.y() * b.x(); };
    double nearest = HUGE_VAL;
    for (const Eigen::Vector4d& wall : m_walls) {
      const Eigen::Vector2d along = wall.tail<2>() - wall.head<2>(),
                            to = wall.head<2>() - from.head<2>();
      const double sine = cross(beam, along), range = cross(to, along) / sine,
                   at = cross(to, beam) / sine;
      if (range > 0 && at >= 0 && at <= 1) nearest = std::min(nearest, range);
    }
    return nearest;
  }

  std::mt19937 m_random{5};
  std::vector<Eigen::Vector4d> m_walls;  ///< x and y of both ends, m
};

/** A part of a recording goes on at the end of another one, as if the robot had not moved. */
void append(Recording& r, const Recording& part, std::size_t from, std::size_t to) {
  const Eigen::Isometry3d T = r.odometry.back() * part.odometry[from].inverse();
  for (std::size_t i = from; i < to; ++i) {
    r.clouds.push_back(part.clouds[i]);
    r.truth.push_back(part.truth[i]);
    r.odometry.push_back(T * part.odometry[i]);
  }
}

}  // namespace

TEST(Planar, whatTwoPlacesFitIsTold) {
  SlamReport report;
  EXPECT_TRUE(report.warnings().empty());
  report.open = 3;
  report.apart = 0.44;
  report.unheld = 31.2;
  ASSERT_EQ(report.warnings().size(), 3u);
  EXPECT_TRUE(contains(report.warnings()[0], "in either of two places, by 3 of its looks"));
  EXPECT_TRUE(contains(report.warnings()[1], "are drawn up to 0.4 m beside themselves"));
  EXPECT_TRUE(contains(report.warnings()[2], "31 m of the way had no hold along corridors"));
}

TEST(Planar, scansThatStandWhileOdometryMovesAreTold) {
  SlamReport report;
  report.hasOdometry = true;
  report.way = 19;
  report.wayError = 12;
  ASSERT_EQ(report.warnings().size(), 1u);
  EXPECT_TRUE(contains(report.warnings()[0], "odometry says 1200 % more way"));
}

TEST(Planar, aScannerThatStandsWithoutOdometryDoesNotMoveBackward) {
  Block street;
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0, 0.03f);
  Slam slam({});
  for (int i = 0; i < 3000; ++i) {
    LabeledCloud cloud = street.seenAt(Eigen::Isometry3d::Identity());
    for (Eigen::Vector3f& p : cloud.points) p *= 1 + noise(random) / p.norm();
    slam.add(cloud, Eigen::Isometry3d::Identity(), std::nullopt);
  }
  EXPECT_EQ(warningsOf(slam), "");
}

TEST(Planar, aWallIsThinAcrossItselfAndHasNoHeight) {
  Submap submap(1, false, true);
  submap.add(wall(0.3f), Eigen::Isometry3d::Identity());
  submap.finish();
  double squared = 0;
  const auto* d = submap.find({0.5, 0.6, 0.15}, semantic_types::kNoClass, squared);
  ASSERT_NE(d, nullptr);
  const double along = (8 * 8 - 1) / 12. * 0.125 * 0.125, across = 0.03 * 0.03;
  EXPECT_NEAR(d->information(0, 0), 1 / along, 1e-3);
  EXPECT_NEAR(d->information(1, 1), 1 / across, 1e-2);
  EXPECT_NEAR(d->information.row(2).norm() + d->information.col(2).norm(), 0, 1e-9);
  EXPECT_NEAR(squared, 0.1 * 0.1 / across, 1e-3);
  const double byChance = 12 * (1 + 2 * std::sqrt(0.8 / 8));
  EXPECT_NEAR(d->evidence(0, 0), 0, 1e-9) << "it goes on";
  EXPECT_NEAR(d->evidence(1, 1), 1 / across - byChance, 1e-2);
  EXPECT_NEAR(d->evidence.row(2).norm() + d->evidence.col(2).norm(), 0, 1e-9);
}

TEST(Planar, wallsInSmallCubesAreThinner) {
  for (const double edge : {1, 4}) {
    Submap submap(edge, false, true);
    submap.add(wall(0), Eigen::Isometry3d::Identity());
    submap.finish();
    double squared = 0;
    ASSERT_NE(submap.find({0.5, 0.7, 0}, semantic_types::kNoClass, squared), nullptr);
    EXPECT_NEAR(squared, std::pow(0.2 / (0.03 * edge), 2), 0.01 * squared) << edge;
  }
}

TEST(Planar, aRowOfVoxelsIsAWallAsWideAsThey) {
  LabeledCloud middles;
  for (int i = 0; i < 5; ++i) middles.points.emplace_back(0.1f + 0.2f * i, 0.5f, 0.f);
  Submap submap(1, false, true);
  submap.add(middles, Eigen::Isometry3d::Identity(), 0.2 / std::sqrt(12));
  submap.finish();
  double squared = 0;
  const auto* d = submap.find({0.5, 0.5, 0}, semantic_types::kNoClass, squared);
  ASSERT_NE(d, nullptr);
  EXPECT_NEAR(d->information(0, 0), 12, 1e-4) << "they fill the cube";
  EXPECT_NEAR(d->evidence(0, 0), 0, 1e-4) << "so they say nothing along it";
  EXPECT_NEAR(d->information(1, 1), 12 / (0.2 * 0.2), 1e-2);
}

TEST(Planar, inSpaceALineOfPointsMayBeARingOnAWiderSurface) {
  Submap submap(1, false);
  submap.add(wall(0), Eigen::Isometry3d::Identity());
  submap.finish();
  double squared = 0;
  ASSERT_NE(submap.find({0.5, 0.6, 0.15}, semantic_types::kNoClass, squared), nullptr);
  EXPECT_LT(squared, 1);
}

TEST(Planar, heightsOfPointsDoNotMatter) {
  Submap submap(1, false, true);
  submap.add(wall(0.3f), Eigen::Isometry3d::Identity());
  submap.finish();
  double here = 0, above = 0;
  const auto* d = submap.find({0.5, 0.6, 0.15}, semantic_types::kNoClass, here);
  ASSERT_NE(d, nullptr);
  EXPECT_EQ(submap.find({0.5, 0.6, 7}, semantic_types::kNoClass, above), d);
  EXPECT_EQ(above, here);
}

TEST(Planar, aLaserScannersLoopCloses) {
  const Recording r = recordingOf("village", 1, laserOf(), kWhole, kFlat);
  Slam slam({});
  addAll(slam, r, kRobotLaser);
  const PathErrors odometry = errorsOf(r.odometry, r), e = errorsOf(slam.poses(), r);
  EXPECT_GT(odometry.rootMeanSquare, 9);
  EXPECT_GT(slam.report().loops, 0u);
  EXPECT_LT(e.rootMeanSquare, 0.045);
  EXPECT_LT(e.last, 0.06);
  EXPECT_LT(e.degrees, 0.2);
  const TemporaryFolder folder;
  Slam inFile({}, folder.path());
  addAll(inFile, r, kRobotLaser);
  EXPECT_TRUE(slam.finish() && inFile.finish()) << "loops wait for it";
  for (std::size_t k = 0; k < slam.poses().size(); ++k)
    EXPECT_EQ(inFile.poses()[k].matrix(), slam.poses()[k].matrix()) << k;
}

/** Wheels slip by 23 % over 76 m where nothing else says how far the robot came. The graph does
 * not believe a loop that is off by so much, but it is there. */
TEST(Planar, aPlaceIsFoundFartherAwayThanTheNearWindow) {
  Block block;
  Slam slam({});
  Eigen::Isometry3d truth(Eigen::Translation3d(0, -1, 0)), odometry = truth;
  std::vector<Eigen::Isometry3d> keyframes;
  const auto drive = [&](double way, double turn) {
    const int steps = std::max(16, static_cast<int>(std::lround(way / 0.4)));
    const Eigen::Isometry3d T_turn = Block::turned(turn / steps);
    for (int i = 0; i < steps; ++i) {
      const Eigen::Vector3d at = truth.translation(), step(way / steps, 0, 0);
      const bool slips = at.y() < -0.5 && std::abs(at.x() - 50) < 38;
      truth = truth * Eigen::Translation3d(step) * T_turn;
      odometry = odometry * Eigen::Translation3d((slips ? 0.77 : 1) * step) * T_turn;
      if (slam.add(block.seenAt(truth), Eigen::Isometry3d::Identity(), odometry).isNew)
        keyframes.push_back(truth);
    }
  };
  for (const double side : {300, 20, 300, 20}) drive(side, 0), drive(0, M_PI / 2);
  drive(10, 0);
  int right = 0;
  for (const PoseEdge& e : slam.edges())
    right +=
        e.isDoubtful && e.b > e.a + 500 &&
        (keyframes[e.a].inverse() * keyframes[e.b] * e.T_a_b.inverse()).translation().norm() < 0.3;
  EXPECT_GT(right, 0);
}

TEST(Planar, amongEqualPillarsLoopsStayOpenAndNothingIsSaidAgainstTheMap) {
  Block hall(1.2);
  Recording r;
  const auto add = [&](double x, double heading) {
    r.truth.push_back(Eigen::Translation3d(x, 0, 0) * Block::turned(heading));
    r.clouds.push_back(hall.seenAt(r.truth.back()));
  };
  for (int x = 0; x < 50; ++x) add(x, 0);
  for (int i = 0; i < 15; ++i) add(50, i * M_PI / 15);
  for (int x = 50; x >= 0; --x) add(x, M_PI);
  r.odometry = r.truth;
  Slam slam({});
  addAll(slam, r, Eigen::Isometry3d::Identity());
  EXPECT_GT(slam.report().open, 0u);
  EXPECT_FALSE(slam.finish());
  EXPECT_EQ(slam.report().loops, 0u);
  EXPECT_EQ(slam.report().apart, 0);
}

/** Something near hides three beams in ten of a scanner that sees 8 m. Then no look while it drives
 * tells enough that the robot is back. */
TEST(Planar, aLoopThatNobodySawWhileDrivingIsFoundAtTheEnd) {
  Recording r = recordingOf("park", 1, laserOf(), kWhole, kFlat);
  std::mt19937 random(3);
  const auto share = [&random] { return static_cast<float>(random() / 4294967296.0); };
  for (LabeledCloud& cloud : r.clouds) {
    std::vector<Eigen::Vector3f> near;
    for (const Eigen::Vector3f& p : cloud.points) {
      if (p.norm() > 8) continue;
      const bool isHidden = share() < 0.3f;
      near.push_back(isHidden ? (0.5f + share()) / p.norm() * p : p);
    }
    cloud.points = near;
  }
  Slam slam({});
  addAll(slam, r, kRobotLaser);
  const std::size_t loops = slam.report().loops;
  const PathErrors before = errorsOf(slam.poses(), r);
  EXPECT_TRUE(slam.finish());
  EXPECT_GT(slam.report().loops, loops);
  EXPECT_LT(errorsOf(slam.poses(), r).last, 0.8 * before.last);
  EXPECT_LE(errorsOf(slam.poses(), r).rootMeanSquare, before.rootMeanSquare);
}

TEST(Planar, anApertureThatIsSaidToBeHalfIsNoticed) {
  Recording r = recordingOf("village", 1, laserOf(), kDriven, kFlat);
  EXPECT_EQ(warningsOf(r), "");
  for (LabeledCloud& cloud : r.clouds)
    for (Eigen::Vector3f& p : cloud.points) {
      const float angle = std::atan2(p.y(), p.x()) / 2, distance = p.head<2>().norm();
      p.head<2>() << distance * std::cos(angle), distance * std::sin(angle);
    }
  EXPECT_NE(warningsOf(r).find("as if the scanner's aperture were "), std::string::npos);
}

TEST(Planar, odometryThatStandsStillWhileTheRobotDrivesIsNoticed) {
  Recording r = recordingOf("village", 1, laserOf(), kDriven, kFlat);
  const Eigen::Isometry3d T_stopped = r.odometry[40], T_on = T_stopped * r.odometry[55].inverse();
  for (std::size_t i = 41; i < r.odometry.size(); ++i)
    r.odometry[i] = i < 55 ? T_stopped : T_on * r.odometry[i];
  EXPECT_NE(warningsOf(r).find("odometry stood still while the robot drove 1"), std::string::npos)
      << warningsOf(r);
}

TEST(Planar, aScannerThatIsMountedBackwardIsNamed) {
  Recording r = recordingOf("village", 1, laserOf(), kDriven, kFlat);
  for (LabeledCloud& cloud : r.clouds)
    for (Eigen::Vector3f& p : cloud.points) p.head<2>() *= -1;
  EXPECT_NE(warningsOf(r).find("scans move backward"), std::string::npos) << warningsOf(r);
}

TEST(Planar, aRobotThatIsTurnedWhereItStandsIsNotLost) {
  Recording r = recordingOf("village", 1, laserOf(), kDriven, kFlat);
  const std::size_t half = r.odometry.size() / 2;
  const Eigen::Isometry3d T_turned = r.odometry[half - 1] *
                                     Eigen::AngleAxisd(-80 * M_PI / 180, Eigen::Vector3d::UnitZ()) *
                                     r.odometry[half].inverse();
  for (std::size_t i = half; i < r.odometry.size(); ++i) r.odometry[i] = T_turned * r.odometry[i];
  Slam slam({});
  addAll(slam, r, kRobotLaser);
  EXPECT_EQ(slam.report().lost, 0u);
  EXPECT_LT(errorsOf(slam.poses(), r).rootMeanSquare, 0.06);
}

TEST(Planar, aRobotThatWasCarriedIsFoundWhileItDrives) {
  const Recording whole = recordingOf("village", 1, laserOf(), 120, kFlat);
  Recording r = whole;
  append(r, whole, 20, 60);  // from 120 m back to 20 m
  Slam slam({});
  addAll(slam, r, kRobotLaser);
  EXPECT_LT(errorsOf(slam.poses(), r).largest, 0.3);
  EXPECT_EQ(slam.report().torn, 1u);
  EXPECT_EQ(slam.report().joined, 1u);
  EXPECT_FALSE(slam.outnumbered(1).empty());  // pieces forget nothing
}

TEST(Planar, aRobotThatWasCarriedTwiceIsFoundInTheEnd) {
  const Recording whole = recordingOf("village", 1, laserOf(), 120, kFlat);
  Recording r = recordingOf("village", 1, laserOf(), 40, kFlat);
  append(r, whole, 80, 100);  // nothing of it was seen yet
  append(r, whole, 10, 110);
  Slam slam({});
  addAll(slam, r, kRobotLaser);
  slam.finish();
  EXPECT_LT(errorsOf(slam.poses(), r).largest, 0.3);
  EXPECT_EQ(slam.report().torn, 2u);
  EXPECT_EQ(slam.report().joined, 2u);
  EXPECT_NE(warningsOf(slam).find("the robot was found again up to "), std::string::npos)
      << warningsOf(slam);
}

TEST(Planar, othersComeToThePartThatAMapHolds) {
  const Recording whole = recordingOf("village", 1, laserOf(), kWhole, kFlat);
  SemanticOcTree map(0.1, synthetic_world::classTable());
  for (std::size_t i = 190; i < 215; ++i)
    map.insert(whole.clouds[i], whole.truth[i] * kRobotLaser, {});
  Recording r = recordingOf("village", 1, laserOf(), 120, kFlat);
  const Eigen::Isometry3d T = whole.truth[187] * r.odometry.back().inverse();
  for (Eigen::Isometry3d& pose : r.odometry) pose = T * pose;
  append(r, whole, 187, whole.truth.size());
  const auto round = static_cast<std::ptrdiff_t>(r.truth.size());
  append(r, whole, 15, 50);  // where it began
  r.clouds.erase(r.clouds.begin() + round);
  for (auto* poses : {&r.truth, &r.odometry}) poses->erase(poses->begin() + round);
  Slam slam({});
  slam.setReference(map);
  addAll(slam, r, kRobotLaser);
  slam.finish();
  EXPECT_GT(slam.report().referenced, 3u);
  EXPECT_EQ(slam.report().joined, 1u);
  EXPECT_LT(errorsOf(slam.poses(), r).largest, 0.3);
}

TEST(Planar, logsOfTwoPlacesAreSaidToBeApart) {
  Recording r = recordingOf("village", 1, laserOf(), kDriven, kFlat);
  append(r, recordingOf("park", 4, laserOf(), kDriven, kFlat), 0, 60);
  EXPECT_NE(warningsOf(r).find("at one place scans fit nothing that was seen before, and only "
                               "odometry leads across"),
            std::string::npos)
      << warningsOf(r);
}

TEST(Planar, whereTheRobotWasCarriedToIsNotWhereItWasCarriedFrom) {
  Recording r = recordingOf("village", 1, laserOf(), 120, kFlat);
  Recording park = recordingOf("park", 4, laserOf(), kDriven, kFlat);
  for (std::size_t i = park.truth.size() - 1; i-- > 0;) {  // and back again
    park.clouds.push_back(park.clouds[i]);
    park.truth.push_back(park.truth[i]);
    park.odometry.push_back(park.odometry[i]);
  }
  append(r, park, 30, park.truth.size());  // in the end beyond where it began
  Slam slam({});
  addAll(slam, r, kRobotLaser);
  EXPECT_EQ(slam.report().torn, 1u);
  slam.finish();
  EXPECT_EQ(slam.report().torn, 1u);
  EXPECT_EQ(slam.report().joined, 0u);
}

TEST(Planar, aScannerThatIsBlindForAMomentTearsNothing) {
  Recording r = recordingOf("village", 1, laserOf(), kDriven, kFlat);
  std::mt19937 random(1);
  for (const std::size_t i : {30, 31, 60})
    for (Eigen::Vector3f& p : r.clouds[i].points) p.head<2>() *= 0.1f + random() % 100 * 0.01f;
  Slam slam({});
  addAll(slam, r, kRobotLaser);
  slam.finish();
  EXPECT_GE(slam.report().lost, 1u);
  EXPECT_EQ(warningsOf(slam), "");
  EXPECT_LT(errorsOf(slam.poses(), r).largest, 0.3);
}

TEST(Planar, aDriveIsInTheFrameOfALaserScannersMap) {
  Recording r = recordingOf("village", 3, laserOf(), kDriven, kFlat);
  moveOdometry(r);
  Slam alone({});
  addAll(alone, r, kRobotLaser);
  EXPECT_GT(errorsOf(alone.poses(), r).largest, 1);
  for (const double voxelSize : {0.1, 0.2, 0.4}) {
    Slam slam({});
    slam.setReference(mapOf(voxelSize, laserOf(), kRobotLaser));
    addAll(slam, r, kRobotLaser);
    const PathErrors e = errorsOf(slam.poses(), r);
    EXPECT_LT(e.first, 0.3 * voxelSize) << voxelSize;
    EXPECT_LT(e.largest, 0.03 + 0.2 * voxelSize) << voxelSize;
    EXPECT_LT(e.degrees, 0.3) << voxelSize;
    EXPECT_GT(slam.report().referenced, kDriven / 4) << voxelSize;
    EXPECT_EQ(slam.report().undone, 0u) << voxelSize;
  }
}

TEST(Planar, aDriveIsInTheFrameOfAMapInSpace) {
  Recording r = recordingOf("village", 3, laserOf(), kDriven, kFlat);
  moveOdometry(r);
  SlamOptions options;
  options.useClasses = false;
  Slam slam(options);
  slam.setReference(mapOf(0.2, lidarOf(0), kRobotLidar));
  addAll(slam, r, kRobotLaser);
  const PathErrors e = errorsOf(slam.poses(), r);
  EXPECT_LT(e.first, 0.2 / std::sqrt(12)) << "as well as its voxels say";
  EXPECT_LT(e.largest, 0.06);
  EXPECT_LT(e.degrees, 0.3);
}

TEST(Planar, whatIsAtOtherHeightsIsNotCompared) {
  // A map of walls 1 m beside those that are there, but 1 m higher.
  const Recording r = recordingOf("village", 1, laserOf(), 10, kFlat);
  SemanticOcTree map(0.2, synthetic_world::classTable());
  for (std::size_t k = 0; k < r.truth.size(); ++k)
    map.insert(r.clouds[k], Eigen::Translation3d(1, 0, 1) * r.truth[k] * kRobotLaser, {});
  Slam slam({});
  slam.setReference(map);
  addAll(slam, r, kRobotLaser);
  EXPECT_EQ(slam.report().referenced, 0u);
  EXPECT_LT((slam.poses()[0].translation() - r.odometry[0].translation()).norm(), 1e-9);
}
