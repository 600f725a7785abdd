#include <gtest/gtest.h>
#include <labeled_cloud/Trajectory.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <rapidcheck.h>

#include <Eigen/Geometry>

#include "RawlogFile.h"
#include "TemporaryFolder.h"

using namespace labeled_cloud;
using mrpt::poses::CPose3D;

namespace {

Trajectory::Time at(double seconds) { return mrpt::Clock::fromDouble(seconds); }

double apart(const CPose3D& a, const CPose3D& b) {
  return (a.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>() -
          b.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>())
      .asEigen()
      .cwiseAbs()
      .maxCoeff();
}

Eigen::Matrix3d rotation(const CPose3D& pose) { return pose.getRotationMatrix().asEigen(); }

CPose3D randomPose() {
  const auto number = [] { return *rc::gen::inRange(-3000, 3001) / 1000.0; };
  return CPose3D(number(), number(), number(), number(), number() / 2, number());
}

mrpt::obs::CObservationRobotPose::Ptr robotPose(double time, const CPose3D& pose) {
  auto obs = mrpt::obs::CObservationRobotPose::Create();
  obs->timestamp = at(time);
  obs->pose.mean = pose;
  return obs;
}

mrpt::obs::CObservationOdometry::Ptr odometry(double time, const mrpt::poses::CPose2D& pose) {
  auto obs = mrpt::obs::CObservationOdometry::Create();
  obs->timestamp = at(time);
  obs->odometry = pose;
  return obs;
}

mrpt::obs::CActionCollection::Ptr movement(const mrpt::poses::CPose2D& increment) {
  mrpt::obs::CActionRobotMovement2D action;
  action.computeFromOdometry(increment, {});
  auto actions = mrpt::obs::CActionCollection::Create();
  actions->insert(action);
  return actions;
}

mrpt::obs::CSensoryFrame::Ptr frame(const std::vector<mrpt::obs::CObservation::Ptr>& all) {
  auto sf = mrpt::obs::CSensoryFrame::Create();
  for (const auto& obs : all) sf->insert(obs);
  return sf;
}

}  // namespace

TEST(Trajectory, betweenTwoPosesItMovesStraightAndTurnsEvenly) {
  EXPECT_TRUE(rc::check([] {
    const CPose3D a = randomPose(), b = randomPose();
    const double f = *rc::gen::inRange(1, 1000) / 1000.0;
    Trajectory path;
    path.insert(at(100), a);
    path.insert(at(101), b);
    RC_ASSERT(apart(*path.at(at(100)), a) == 0 && apart(*path.at(at(101)), b) == 0);
    const CPose3D c = *path.at(at(100 + f));
    RC_ASSERT(std::abs(c.x() - (1 - f) * a.x() - f * b.x()) < 1e-6);
    RC_ASSERT(std::abs(c.z() - (1 - f) * a.z() - f * b.z()) < 1e-6);
    // independent of quaternions: the turn from a to c is the fraction f of that from a to b
    const Eigen::AngleAxisd whole(Eigen::Matrix3d(rotation(a).transpose() * rotation(b)));
    const Eigen::Matrix3d expected =
        rotation(a) * Eigen::AngleAxisd(f * whole.angle(), whole.axis()).toRotationMatrix();
    if (whole.angle() < 3.1) RC_ASSERT((rotation(c) - expected).cwiseAbs().maxCoeff() < 1e-6);
  }));
}

TEST(Trajectory, outsideItIsNothingButWithinTheToleranceTheEndHolds) {
  TrajectoryOptions options;
  options.tolerance = 0.1;
  Trajectory path(options);
  EXPECT_FALSE(path.at(at(0)));
  path.insert(at(5), CPose3D(1, 0, 0, 0, 0, 0));
  path.insert(at(6), CPose3D(2, 0, 0, 0, 0, 0));
  EXPECT_EQ(path.at(at(4.95))->x(), 1);
  EXPECT_EQ(path.at(at(6.05))->x(), 2);
  EXPECT_FALSE(path.at(at(4.85)));
  EXPECT_FALSE(path.at(at(6.15)));
}

TEST(Trajectory, aLongGapIsNotBridged) {
  TrajectoryOptions options;
  options.tolerance = 0.1;
  options.maxGap = 2;
  Trajectory path(options);
  path.insert(at(0), CPose3D());
  path.insert(at(2), CPose3D(2, 0, 0, 0, 0, 0));
  path.insert(at(5), CPose3D(9, 0, 0, 0, 0, 0));
  EXPECT_NEAR(path.at(at(1))->x(), 1, 1e-9);
  EXPECT_FALSE(path.at(at(3)));
  EXPECT_EQ(path.at(at(2.05))->x(), 2);
  EXPECT_EQ(path.at(at(4.95))->x(), 9);
}

TEST(Trajectory, posesThatAreNotFiniteAreRefused) {
  EXPECT_THROW(Trajectory().insert(at(0), CPose3D(NAN, 0, 0, 0, 0, 0)), std::invalid_argument);
}

TEST(TumTrajectory, readsPosesCommentsAndAnyOrder) {
  const TemporaryFolder folder;
  const auto path = loadTumTrajectory(folder.write("t.txt",
                                                   "# time tx ty tz qx qy qz qw\n\n"
                                                   "2.5 1 2 3 0 0 0.7071068 0.7071068  # turned\r\n"
                                                   "1.5 0 0 0 0 0 0 1\n"));
  ASSERT_EQ(path.size(), 2u);
  EXPECT_LT(apart(*path.at(at(2.5)), CPose3D(1, 2, 3, M_PI / 2, 0, 0)), 1e-6);
}

TEST(TumTrajectory, errorsNameFileAndLine) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& text) {
    const std::string file = folder.write("t.txt", text).string();
    return errorOf([&] { loadTumTrajectory(file); }).substr(file.size());
  };
  for (const auto& [text, words] : std::vector<std::pair<std::string, std::string>>{
           {"0 0 0 0 0 0 0 1\n1 2 3\n", ":2: expected 't tx ty tz qx qy qz qw', found '1 2 3'"},
           {"0 0 x 0 0 0 0 1\n", ":1: expected"},
           {"0 0 nan 0 0 0 0 1\n", ":1: expected"},
           {"0 0 0 0 0 0 0 1 2\n", ":1: more than eight values"},
           {"1e300 0 0 0 0 0 0 1\n", "s is no time"},
           {"1700000000123456789 0 0 0 0 0 0 1\n", "looks like nanoseconds: divide by 1000000000"},
           {"0 0 0 0 0 0 0 0\n", ":1: the quaternion's length is 0"},
           {"0 0 0 0 0 0 0 1e150\n", "length is 1e+150, not 1"},
           {"0 0 0 0 0 0 0 1\n0 0 0 0 0 0 0 1\n", ":2: this time was there"},
           {"# nothing\n", ": no pose in this trajectory"}})
    EXPECT_TRUE(contains(error(text), words));
  EXPECT_TRUE(contains(errorOf([] { loadTumTrajectory("/nowhere/t.txt"); }), "/nowhere/t.txt"));
}

TEST(RawlogTrajectory, robotPosesComeFirst) {
  const TemporaryFolder folder;
  const auto path = readTrajectory({writeRawlog(
      folder / "a.rawlog", {odometry(1, {7, 7, 0}), robotPose(1, CPose3D(1, 2, 3, 0.1, 0.2, 0.3)),
                            robotPose(2, CPose3D(2, 2, 3, 0.1, 0.2, 0.3))})});
  EXPECT_EQ(path.size(), 2u);
  EXPECT_LT(apart(*path.at(at(1.5)), CPose3D(1.5, 2, 3, 0.1, 0.2, 0.3)), 1e-9);
}

TEST(RawlogTrajectory, movementsAddUpInTheRobotsFrame) {
  const TemporaryFolder folder;
  const mrpt::poses::CPose2D step(1, 0, M_PI / 2);
  const auto path = readTrajectory({writeRawlog(
      folder / "a.rawlog",
      {movement({0, 0, 0}), frame({odometry(1, {}), odometry(1.25, {})}), movement(step),
       frame({odometry(2, {})}), movement({2, 0, 0}), frame({odometry(3, {})})})});
  EXPECT_EQ(apart(*path.at(at(1.25)), CPose3D()), 0);
  EXPECT_LT(apart(*path.at(at(2)), CPose3D(1, 0, 0, M_PI / 2, 0, 0)), 1e-9);
  EXPECT_LT(apart(*path.at(at(3)), CPose3D(1, 2, 0, M_PI / 2, 0, 0)), 1e-9);
}

TEST(RawlogTrajectory, movementsIn3dCountToo) {
  const TemporaryFolder folder;
  mrpt::obs::CActionRobotMovement3D action;
  action.poseChange.mean = CPose3D(0, 0, 1, 0, 0.5, 0);
  const auto actions = mrpt::obs::CActionCollection::Create();
  actions->insert(action);
  const auto path =
      readTrajectory({writeRawlog(folder / "a.rawlog", {actions, frame({odometry(1, {})})})});
  EXPECT_LT(apart(*path.at(at(1)), action.poseChange.mean), 1e-9);
}

TEST(RawlogTrajectory, plainOdometryIsTheLastResort) {
  const TemporaryFolder folder;
  const auto path = readTrajectory({writeRawlog(folder / "a.rawlog", {odometry(1, {1, 2, 0.5})}),
                                    writeRawlog(folder / "b.rawlog", {odometry(2, {3, 2, 0.5})})});
  EXPECT_LT(apart(*path.at(at(1.5)), CPose3D(2, 2, 0, 0.5, 0, 0)), 1e-9);
}

TEST(RawlogTrajectory, aPoseThatIsNotFiniteIsNamedWithItsFile) {
  const TemporaryFolder folder;
  const auto file =
      writeRawlog(folder / "a.rawlog", {robotPose(1, CPose3D(INFINITY, 0, 0, 0, 0, 0))});
  const std::string error = errorOf([&] { readTrajectory({file}); });
  EXPECT_TRUE(contains(error, "a.rawlog: trajectory: the pose at 1 s"));
}

TEST(RawlogTrajectory, readsTheOdometryOfARealRobotsRawlog) {
  const std::filesystem::path file =
      "/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs Debian's mrpt-common";
  const auto path = readTrajectory({file});
  EXPECT_EQ(path.size(), 225u);
  double length = 0;
  for (auto it = std::next(path.poses().begin()); it != path.poses().end(); ++it)
    length += (it->second - std::prev(it)->second).norm();
  EXPECT_GT(length, 50);
  EXPECT_LT(length, 500);
}
