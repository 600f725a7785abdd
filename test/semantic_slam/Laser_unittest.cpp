#include <gtest/gtest.h>
#include <labeled_cloud/ScanStream.h>
#include <labeled_cloud/Trajectory.h>
#include <semantic_slam/Slam.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

using namespace semantic_slam;

namespace {

const std::filesystem::path kLog =
    "/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog";

using Path = std::vector<Eigen::Isometry3d>;

/** A laser scanner's scans, where it sat on the robot, and odometry. */
struct Drive {
  std::vector<LabeledCloud> clouds;
  Path T_robot_sensor, odometry;

  Drive() {
    const semantic_types::ClassTable classes;
    labeled_cloud::ScanConverter converter(classes, {});
    const auto trajectory = labeled_cloud::readTrajectory({kLog});
    labeled_cloud::ScanStream stream({kLog}, converter, trajectory, nullptr);
    while (auto read = stream.next()) {
      if (!read->scan) continue;
      clouds.push_back(read->scan->cloud);
      T_robot_sensor.push_back(isometry(read->scan->T_robot_sensor));
      odometry.push_back(isometry(read->T_map_robot));
    }
  }

 private:
  static Eigen::Isometry3d isometry(const mrpt::poses::CPose3D& pose) {
    return Eigen::Isometry3d(pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen());
  }
};

/** Points of the plane, by squares of a meter. */
class Points {
 public:
  void add(const Eigen::Vector2d& p) { m_squares[squareOf(p)].push_back(p); }
  /** To the nearest one, at most 1 m. */
  double distance(const Eigen::Vector2d& p) const {
    const auto [x, y] = squareOf(p);
    double least = 1;
    for (int i = 0; i < 9; ++i)
      if (const auto s = m_squares.find({x + i % 3 - 1, y + i / 3 - 1}); s != m_squares.end())
        for (const Eigen::Vector2d& q : s->second) least = std::min(least, (p - q).norm());
    return least;
  }

 private:
  static std::pair<int, int> squareOf(const Eigen::Vector2d& p) {
    return {static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y()))};
  }
  std::map<std::pair<int, int>, std::vector<Eigen::Vector2d>> m_squares;
};

/** How far what the second half of the scans saw within 15 m is from what the first half saw, m. */
double blurOf(const Drive& drive, const Path& poses) {
  Points first;
  double sum = 0;
  int n = 0;
  for (std::size_t i = 0; i < poses.size(); ++i)
    for (const Eigen::Vector3f& p : drive.clouds[i].points) {
      if (p.norm() > 15) continue;
      const Eigen::Vector2d q = (poses[i] * drive.T_robot_sensor[i] * p.cast<double>()).head<2>();
      if (2 * i < poses.size()) {
        first.add(q);
      } else {
        sum += first.distance(q);
        ++n;
      }
    }
  return sum / n;
}

}  // namespace

TEST(Slam, closesTheLoopOfARealLaserScanner) {
  if (!std::filesystem::exists(kLog)) GTEST_SKIP() << "needs Debian's mrpt-common";
  const Drive drive;
  ASSERT_EQ(drive.clouds.size(), 225u);
  Slam slam({});
  std::vector<Slam::Added> added;
  for (std::size_t i = 0; i < drive.clouds.size(); ++i)
    added.push_back(slam.add(drive.clouds[i], drive.T_robot_sensor[i], drive.odometry[i]));
  EXPECT_GT(slam.report().loops, 0u);
  Path corrected;
  for (const Slam::Added& a : added)
    corrected.push_back(slam.poses()[a.keyframe] * a.T_keyframe_robot);
  for (const Eigen::Isometry3d& T : corrected) {
    EXPECT_NEAR(T.translation().z(), 0, 1e-9) << "no beam tells of heights";
    EXPECT_NEAR(T(2, 2), 1, 1e-9);
  }
  EXPECT_LT(blurOf(drive, corrected), 0.6 * blurOf(drive, drive.odometry));
}
