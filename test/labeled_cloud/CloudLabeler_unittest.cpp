#include <gtest/gtest.h>
#include <labeled_cloud/CloudLabeler.h>
#include <mrpt/obs/CObservationImage.h>

#include <map>

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

}  // namespace

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
    EXPECT_TRUE(contains(error, "CObservationImage 'front' at 10")) << error;
    EXPECT_TRUE(contains(error, expected)) << error;
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
  options = {};
  options.occlusionParallax = NAN;
  EXPECT_TRUE(contains(errorOf([&] { make({}, options); }), "occlusion_parallax"));
}
