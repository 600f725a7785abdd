#include <gtest/gtest.h>
#include <labeled_cloud/CloudLabeler.h>
#include <labeled_cloud/Pictures.h>
#include <mrpt/obs/CObservationImage.h>

#include <cmath>
#include <map>
#include <random>

#include "TemporaryFolder.h"

using namespace labeled_cloud;
using mrpt::obs::CObservationImage;
using mrpt::poses::CPose3D;
using semantic_types::ClassId;

namespace {

mrpt::Clock::time_point at(double seconds) { return mrpt::Clock::fromDouble(seconds); }

/** Answers for each picture an image that has one class all over; by sensor label. */
class OneClassEach : public ImageLabeler {
 public:
  explicit OneClassEach(std::map<std::string, ClassId> classes, int cols = 100)
      : m_classes(std::move(classes)), m_cols(cols) {}
  std::optional<LabelImage> label(const mrpt::obs::CObservation& observation) override {
    ++asked;
    const auto found = m_classes.find(observation.sensorLabel);
    if (found == m_classes.end()) return std::nullopt;
    LabelImage image;
    image.rows = 100, image.cols = m_cols;
    image.classes.assign(std::size_t(image.rows) * image.cols, found->second);
    image.origin = "a test";
    return image;
  }
  int asked = 0;

 private:
  std::map<std::string, ClassId> m_classes;
  int m_cols;
};

/** A camera of 90 degrees that looks along the robot's x axis turned by YAW degrees. */
mrpt::obs::CObservation::Ptr picture(const std::string& sensor, double seconds, double yaw = 0) {
  auto o = CObservationImage::Create();
  o->sensorLabel = sensor;
  o->timestamp = at(seconds);
  o->cameraParams.ncols = o->cameraParams.nrows = 100;
  o->cameraParams.setIntrinsicParamsFromValues(50, 50, 49.5, 49.5);
  const double right = -M_PI / 2;
  o->cameraPose = CPose3D(0, 0, 0, mrpt::DEG2RAD(yaw), 0, 0) + CPose3D(0, 0, 0, right, 0, right);
  return o;
}

LabeledScan scanOf(const std::vector<Eigen::Vector3f>& points, double seconds) {
  LabeledScan scan;
  scan.cloud.points = points;
  scan.timestamp = at(seconds);
  return scan;
}

/** Drives along x at 10 m/s, at x = 0 at 10 s. */
Trajectory drive() {
  Trajectory trajectory;
  for (const double t : {9.0, 11.0})
    trajectory.insert(at(t), CPose3D(10 * (t - 10), 0, 0, 0, 0, 0));
  return trajectory;
}

class CloudLabelers : public testing::Test {
 protected:
  CloudLabeler make(std::map<std::string, ClassId> classes, const CloudLabelerOptions& options = {},
                    int cols = 100) {
    labels = std::make_shared<OneClassEach>(std::move(classes), cols);
    return {labels, 3, LabelModel(), trajectory, options};
  }
  LabeledScan labeled(CloudLabeler& labeler, const std::vector<Eigen::Vector3f>& points,
                      double seconds) const {
    LabeledScan scan = scanOf(points, seconds);
    labeler.label(scan, *trajectory.at(at(seconds)));
    return scan;
  }

  Trajectory trajectory = drive();
  std::shared_ptr<OneClassEach> labels;
};

using Classes = std::vector<ClassId>;

TEST_F(CloudLabelers, givePointsInTheImageItsClassAndOthersNone) {
  auto labeler = make({{"front", 2}});
  labeler.addPicture(picture("front", 10));
  const auto scan = labeled(labeler, {{5, 0, 0}, {5, 6, 0}, {-5, 0, 0}, {5, 4, 0}}, 10);
  EXPECT_EQ(scan.cloud.classes, (Classes{2, 0, 0, 2}));
  EXPECT_EQ(scan.counts.labeled, 2u);
  EXPECT_FALSE(scan.labelsMissing);
}

TEST_F(CloudLabelers, moveThePointsByWhatTheRobotMovedInBetween) {
  auto labeler = make({{"front", 2}});
  labeler.addPicture(picture("front", 10.05));  // 0.5 m farther on
  const auto scan = labeled(labeler, {{5, 4.4f, 0}, {5, 4.6f, 0}, {0.4f, 0, 0}, {0.6f, 0, 0}}, 10);
  EXPECT_EQ(scan.cloud.classes, (Classes{2, 0, 0, 2}));
}

TEST_F(CloudLabelers, takeThePictureNearestInTimeWithinTheTolerance) {
  auto labeler = make({{"front", 2}});
  for (const double t : {9.9, 10.0, 10.1}) labeler.addPicture(picture("front", t));
  EXPECT_FALSE(labeled(labeler, {{5, 0, 0}}, 10.04).labelsMissing);
  EXPECT_FALSE(labeled(labeler, {{5, 0, 0}}, 10.0).labelsMissing);
  EXPECT_EQ(labels->asked, 1);  // the same picture, labeled once
  const auto scan = labeled(labeler, {{5, 0, 0}}, 10.2);
  EXPECT_TRUE(scan.labelsMissing);
  EXPECT_TRUE(scan.cloud.classes.empty());
}

TEST_F(CloudLabelers, letSeveralCamerasShareTheWorkAndTheNearestInTimeDecide) {
  auto labeler = make({{"front", 1}, {"left", 2}, {"late", 3}});
  labeler.addPicture(picture("late", 10.02));
  labeler.addPicture(picture("front", 10));
  labeler.addPicture(picture("left", 10.01, 90));
  EXPECT_EQ(labeled(labeler, {{5, 0, 0}, {0, 5, 0}, {0, -5, 0}}, 10).cloud.classes,
            (Classes{1, 2, 0}));
}

TEST_F(CloudLabelers, useACalibrationThatIsGivenInsteadOfThePictures) {
  CloudLabelerOptions options;
  const auto ahead = picture("front", 10);
  options.calibrations["front"].T_robot_camera =
      std::dynamic_pointer_cast<CObservationImage>(ahead)->cameraPose;
  auto labeler = make({{"front", 2}}, options);
  labeler.addPicture(picture("front", 10, 180));
  EXPECT_EQ(labeled(labeler, {{5, 0, 0}, {-5, 0, 0}}, 10).cloud.classes, (Classes{2, 0}));
}

TEST_F(CloudLabelers, knowWhetherANearerPictureMayStillCome) {
  auto labeler = make({{"a", 1}, {"b", 1}});
  EXPECT_FALSE(labeler.sawAllCamerasAt(at(10)));
  labeler.addPicture(picture("a", 10.1));
  labeler.addPicture(picture("b", 9.9));
  EXPECT_FALSE(labeler.sawAllCamerasAt(at(10)));
  labeler.addPicture(picture("b", 10));
  EXPECT_TRUE(labeler.sawAllCamerasAt(at(10)));
  labeler.forgetBefore(at(10.5));
  EXPECT_TRUE(labeled(labeler, {{5, 0, 0}}, 10.5).labelsMissing);
}

TEST_F(CloudLabelers, nameAPictureThatCannotBeUsedOrLeaveItOutAndReportIt) {
  const auto uncalibrated = picture("front", 10);
  std::dynamic_pointer_cast<CObservationImage>(uncalibrated)->cameraParams = {};
  CloudLabelerOptions skip;
  skip.skipProblems = true;
  for (const bool wrongSize : {false, true}) {
    const std::string expected = wrongSize ? "labels of 50 x 100 pixels, but the camera is "
                                             "calibrated for 100 x 100"
                                           : "its camera is not calibrated";
    auto strict = make({{"front", 2}}, {}, wrongSize ? 50 : 100);
    strict.addPicture(wrongSize ? picture("front", 10) : uncalibrated);
    const std::string error = errorOf([&] { labeled(strict, {{5, 0, 0}}, 10); });
    EXPECT_TRUE(contains(error, "CObservationImage 'front' at 10"));
    EXPECT_TRUE(contains(error, expected));
    auto lenient = make({{"front", 2}}, skip, wrongSize ? 50 : 100);
    lenient.addPicture(wrongSize ? picture("front", 10) : uncalibrated);
    EXPECT_TRUE(labeled(lenient, {{5, 0, 0}}, 10).labelsMissing);
    EXPECT_TRUE(labeled(lenient, {{5, 0, 0}}, 10).labelsMissing);
    const auto problems = lenient.takeProblems();
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_TRUE(contains(problems[0], expected));
  }
}

TEST_F(CloudLabelers, refuseBadOptionsByName) {
  CloudLabelerOptions options;
  options.tolerance = -1;
  EXPECT_TRUE(contains(errorOf([&] { make({}, options); }), "tolerance is -1"));
}

using Eigen::Isometry3d;
using Eigen::Vector3f;

mrpt::img::TCamera camera(int cols = 320, int rows = 240, double f = 200) {
  mrpt::img::TCamera c;
  c.ncols = cols, c.nrows = rows;
  c.setIntrinsicParamsFromValues(f, f, cols / 2.0, rows / 2.0);
  return c;
}

/** The textbook's formulas of radial and tangential distortion. */
Eigen::Vector2d pixelOf(const mrpt::img::TCamera& c, double x, double y) {
  const double r2 = x * x + y * y;
  const double radial = 1 + c.k1() * r2 + c.k2() * r2 * r2;
  const double u = x * radial + 2 * c.p1() * x * y + c.p2() * (r2 + 2 * x * x);
  const double v = y * radial + c.p1() * (r2 + 2 * y * y) + 2 * c.p2() * x * y;
  return {c.fx() * u + c.cx(), c.fy() * v + c.cy()};
}

/** A wall at 4 m, and a board at 2 m before its middle, as the origin sees them. */
struct BoardBeforeWall {
  std::vector<Vector3f> points;
  std::vector<bool> onBoard;
  BoardBeforeWall() {
    for (float x = -1; x <= 1; x += 0.004f)
      for (float y = -0.5f; y <= 0.5f; y += 0.004f) {
        const bool board = std::abs(x) < 0.2f;
        points.push_back(Vector3f(x, y, 1) * (board ? 2 : 4));
        onBoard.push_back(board);
      }
  }
};

void expectPixelsWhereTheLensSays(const mrpt::img::TCamera& c) {
  Isometry3d T = Isometry3d::Identity();
  T.rotate(Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, 2, 3).normalized()));
  T.translation() = Eigen::Vector3d(0.3, -0.1, 0.2);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-5, 5);
  std::vector<Vector3f> points(5000);
  for (auto& p : points) p = {uniform(random), uniform(random), uniform(random)};
  const auto pixels = visiblePixels(points, T, c, 0);
  int seen = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = T * points[i].cast<double>();
    const double x = p.x() / p.z(), y = p.y() / p.z();
    const Eigen::Vector2d expected = pixelOf(c, x, y);
    const bool inside = p.z() > 0.01 && expected.x() >= -0.5 && expected.x() < 319.5 &&
                        expected.y() >= -0.5 && expected.y() < 239.5;
    ASSERT_EQ(pixels[i].allFinite(), inside) << p.transpose();
    if (!inside) continue;
    ++seen;
    EXPECT_LT((pixels[i].cast<double>() - expected).norm(), 0.01);
  }
  EXPECT_GT(seen, 200);
}

}  // namespace

TEST(VisiblePixels, lieWhereLensAndPoseSay) {
  auto c = camera();
  c.dist = {-0.2, 0.05, 0.001, -0.002, 0, 0, 0, 0};
  c.distortion = mrpt::img::DistortionModel::plumb_bob;
  expectPixelsWhereTheLensSays(c);
  c.setDistortionKannalaBrandt(0.03, -0.01, 0.002, -0.0005);
  EXPECT_TRUE(
      contains(errorOf([&] { visiblePixels({}, Isometry3d::Identity(), c, 0); }), "fisheye"));
}

TEST(VisiblePixels, doNotSeeWhatADisplacedCameraCannotSee) {
  const BoardBeforeWall scene;
  Isometry3d T_camera_points(
      Eigen::Translation3d(-0.3, 0, 0));  // the camera is to the right: the board moves left
  const auto pixels = visiblePixels(scene.points, T_camera_points, camera(), 1.5);
  int hidden = 0, wronglyHidden = 0, wronglySeen = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Vector3f& p = scene.points[i];
    const double x = (p.x() - 0.3) / p.z();  // the board fills -0.35 .. 0.05 there
    if (std::abs(x) > 0.79) continue;        // outside of the image
    const double edge = 0.05;
    const bool behind = !scene.onBoard[i] && x > -0.35 && x < 0.05;
    const bool clearlyBehind = behind && x > -0.35 + edge && x < 0.05 - edge;
    const bool clearlySeen = scene.onBoard[i] || x < -0.35 - edge || x > 0.05 + edge;
    hidden += !pixels[i].allFinite();
    wronglySeen += clearlyBehind && pixels[i].allFinite();
    wronglyHidden += clearlySeen && !pixels[i].allFinite();
  }
  EXPECT_GT(hidden, 3000);
  EXPECT_EQ(wronglySeen, 0);
  EXPECT_EQ(wronglyHidden, 0);
}

TEST(VisiblePixels, seeGroundAtGrazingAnglesFromBesideTheSensor) {
  std::vector<Vector3f> ground;  // as a LiDAR of 64 rings at 1.7 m sees it, y down
  for (double down = 3; down < 25; down += 0.4)
    for (double turn = -30; turn < 30; turn += 0.2) {
      const double range = 1.7 / std::tan(down * M_PI / 180), a = turn * M_PI / 180;
      ground.emplace_back(range * std::sin(a), 1.7, range * std::cos(a));
    }
  Isometry3d T_camera_points(Eigen::Translation3d(0, -0.3, -0.3));
  const auto c = camera(1240, 376, 720);
  const auto all = visiblePixels(ground, T_camera_points, c, 0);
  const auto seen = visiblePixels(ground, T_camera_points, c, 1.5);
  std::size_t inImage = 0, hidden = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    inImage += all[i].allFinite();
    hidden += all[i].allFinite() && !seen[i].allFinite();
  }
  EXPECT_GT(inImage, 3000u);
  EXPECT_EQ(hidden, 0u);
}
