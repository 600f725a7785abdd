// Labels painted into images come back to the points that they were painted from.
#include <gtest/gtest.h>
#include <labeled_cloud/CloudLabeler.h>
#include <labeled_cloud/ScanConverter.h>
#include <labeled_cloud/Trajectory.h>
#include <mrpt/obs/CObservationImage.h>
#include <semantic_types/ClassTable.h>

#include <algorithm>
#include <cmath>

#include "CountedLabels.h"
#include "DataSets.h"
#include "SharedData.h"

using labeled_cloud::LabeledScan;
using labeled_cloud::LabelImage;
using mrpt::poses::CPose3D;

namespace {

/** Gives every observation the same label image. */
class OneImage : public labeled_cloud::ImageLabeler {
 public:
  explicit OneImage(const LabelImage& image) : m_image(image) {}
  std::optional<LabelImage> label(const mrpt::obs::CObservation&) override { return m_image; }

 private:
  LabelImage m_image;
};

/** Radial distortion of the first order, the same in both places: painting and calibration. */
struct PaintingCamera {
  mrpt::img::TCamera camera;
  PaintingCamera(int cols, int rows, double f, double cx, double cy, double k1 = 0) {
    camera.ncols = cols, camera.nrows = rows;
    camera.setIntrinsicParamsFromValues(f, f, cx, cy);
    camera.dist[0] = k1;
    camera.distortion = mrpt::img::DistortionModel::plumb_bob;
  }
  Eigen::Vector2d project(const Eigen::Vector3d& p) const {
    const double x = p.x() / p.z(), y = p.y() / p.z();
    const double radial = 1 + camera.k1() * (x * x + y * y);
    return {camera.fx() * x * radial + camera.cx(), camera.fy() * y * radial + camera.cy()};
  }
};

/** Paints each labeled point as a square of 2 RADIUS + 1 pixels, the nearest on top. */
LabelImage paint(const semantic_types::LabeledCloud& cloud, const Eigen::Isometry3d& T_camera_cloud,
                 const PaintingCamera& c, int radius) {
  LabelImage image;
  image.rows = int(c.camera.nrows), image.cols = int(c.camera.ncols);
  image.classes.assign(std::size_t(image.rows) * image.cols, kNoClass);
  image.origin = "painted";
  image.view = LabelImage::View::Color;
  std::vector<double> depth(image.classes.size(), HUGE_VAL);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d p = T_camera_cloud * cloud.points[i].cast<double>();
    if (p.z() < 0.1 || p.head<2>().norm() > 1.5 * p.z()) continue;
    const Eigen::Vector2d pixel = c.project(p);
    const int u = int(std::lround(pixel.x())), v = int(std::lround(pixel.y()));
    for (int row = std::max(0, v - radius); row <= std::min(image.rows - 1, v + radius); ++row)
      for (int col = std::max(0, u - radius); col <= std::min(image.cols - 1, u + radius); ++col) {
        const std::size_t at = std::size_t(row) * image.cols + col;
        if (p.z() >= depth[at]) continue;
        depth[at] = p.z();
        image.classes[at] = cloud.classes[i];
      }
  }
  return image;
}

/** Counts the points that have a class and received one, and those that received their own. */
struct Share {
  std::size_t points = 0, same = 0;
  double value() const { return double(same) / double(points); }
  void add(const std::vector<ClassId>& own, const std::vector<ClassId>& received) {
    for (std::size_t i = 0; i < own.size(); ++i) {
      const bool both = own[i] != kNoClass && received[i] != kNoClass;
      points += both;
      same += both && own[i] == received[i];
    }
  }
};

/** P2 * Tr of SemanticKITTI's sequence 00, from its calib.txt. */
const PaintingCamera kKittiCamera(1241, 376, 718.856, 607.1928, 185.2157);
Eigen::Isometry3d kittiCameraFromLidar() {
  Eigen::Isometry3d Tr = Eigen::Isometry3d::Identity();
  Tr.matrix().topRows<3>() << 4.276802385584e-04, -9.999672484946e-01, -8.084491683471e-03,
      -1.198459927713e-02, -7.210626507497e-03, 8.081198471645e-03, -9.999413164504e-01,
      -5.403984729748e-02, 9.999738645903e-01, 4.859485810390e-04, -7.206933692422e-03,
      -2.921968648686e-01;
  return Eigen::Translation3d(45.38225 / 718.856, -0.1130887 / 718.856, 0.003779761) * Tr;
}

/** Labels a street's scans by pictures that their labels were painted into. \param wrong Degrees by
 * which the calibration is turned. */
Share labelStreetByCamera(double wrong) {
  const ClassTable table = shippedTable("semantic_kitti.yaml");
  const Eigen::Isometry3d T_camera_lidar = kittiCameraFromLidar();
  const CPose3D T_lidar_camera(mrpt::math::CMatrixDouble44(T_camera_lidar.inverse().matrix()));
  const CPose3D turn(0, 0, 0, mrpt::DEG2RAD(wrong), 0, 0);
  Share share;
  for (const LabeledFrame& frame :
       readSemanticKitti(sharedDataDir() / "semantic_kitti/00", table)) {
    labeled_cloud::Trajectory still;
    still.insert(mrpt::Clock::fromDouble(1), CPose3D());
    const auto labels =
        std::make_shared<OneImage>(paint(frame.cloud, T_camera_lidar, kKittiCamera, 2));
    labeled_cloud::CloudLabeler labeler(labels, table.size(), {}, still);
    auto picture = mrpt::obs::CObservationImage::Create();
    picture->timestamp = mrpt::Clock::fromDouble(1);
    picture->cameraParams = kKittiCamera.camera;
    picture->cameraPose = turn + T_lidar_camera;
    labeler.addPicture(picture);
    LabeledScan scan;
    scan.timestamp = picture->timestamp;
    scan.cloud.points = frame.cloud.points;
    labeler.label(scan, CPose3D());
    share.add(frame.cloud.classes, scan.cloud.classes);
  }
  return share;
}

/** Labels a flat's depth images by the color image of a camera beside, painted from the labels. */
Share labelFlatByColorCamera(double occlusionParallax) {
  const ClassTable table = shippedTable("replica_apartment.yaml");
  const PaintingCamera color(640, 480, 300, 320, 240, -0.1);
  const CPose3D beside = CPose3D(0.02, -0.25, 0.05, mrpt::DEG2RAD(3.0), mrpt::DEG2RAD(-2.0), 0) +
                         mrpt::obs::CObservation3DRangeScan().relativePoseIntensityWRTDepth;
  labeled_cloud::ScanConverterOptions options;
  options.occlusionParallax = occlusionParallax;
  Share share;
  const auto frames = readReplica(sharedDataDir() / "replica_apartment_0", 55);
  for (std::size_t f = 0; f < frames.size(); f += 11) {
    mrpt::obs::CObservation3DRangeScan scan;
    scan.hasRangeImage = true;
    scan.rangeUnits = 1 / 6553.5f;
    scan.cameraParams.ncols = scan.cameraParams.nrows = 512;
    scan.cameraParams.setIntrinsicParamsFromValues(256, 256, 255.5, 255.5);
    scan.rangeImage_setSize(512, 512);
    scan.rangeImage.setZero();
    scan.cameraParamsIntensity = color.camera;
    scan.relativePoseIntensityWRTDepth = beside;
    semantic_types::LabeledCloud cloud = frames[f].cloud;
    for (auto& p : cloud.points) {  // the data set looks along z, MRPT along x
      const Eigen::Array2f pixel = 256.f / p.z() * p.head<2>().array() + 255.5f;
      scan.rangeImage(std::lround(pixel.y()), std::lround(pixel.x())) =
          static_cast<std::uint16_t>(std::lround(p.z() / scan.rangeUnits));
      p = Eigen::Vector3f(p.z(), -p.x(), -p.y());
    }
    const auto labels = std::make_shared<OneImage>(
        paint(cloud, labeled_cloud::toEigen(beside).inverse(), color, 1));
    const auto converted = labeled_cloud::ScanConverter(table, options, labels).convert(scan);
    share.add(cloud.classes, converted->cloud.classes);
  }
  return share;
}

}  // namespace

TEST(CameraOverLidar, givesThePointsOfAStreetTheirOwnClassesBack) {
  SKIP_WITHOUT_DATA("semantic_kitti");
  const Share right = labelStreetByCamera(0), turned = labelStreetByCamera(2);
  RecordProperty("right", std::to_string(right.value()));
  RecordProperty("turned", std::to_string(turned.value()));
  RecordProperty("points", std::to_string(right.points));
  EXPECT_GE(right.value(), 0.97);
  EXPECT_GT(right.points, 100000u);
  EXPECT_LT(turned.value(), 0.90);
}

TEST(DisplacedColorCamera, labelsTheRightSurfacesIfHiddenPointsAreLeftOut) {
  SKIP_WITHOUT_DATA("replica_apartment_0");
  const Share tested = labelFlatByColorCamera(1.5), untested = labelFlatByColorCamera(0);
  RecordProperty("tested", std::to_string(tested.value()));
  RecordProperty("untested", std::to_string(untested.value()));
  EXPECT_GE(tested.value(), 0.97);
  EXPECT_GT(double(tested.points), 0.85 * double(untested.points));
  EXPECT_LT(1 - tested.value(), 0.7 * (1 - untested.value()));
}
