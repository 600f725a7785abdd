#include <gtest/gtest.h>
#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/Rawlogs.h>
#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt_compat/Release.h>
#if MSO_MRPT_AT_LEAST(2, 15, 0)
#include <mrpt/maps/CGenericPointsMap.h>
#elif MSO_MRPT_AT_LEAST(2, 14, 0)
#include <mrpt/maps/CPointsMapXYZIRT.h>
#endif

#include <algorithm>
#include <sstream>

#include "Classes.h"
#include "Conversions.h"
#include "RawlogFile.h"

using namespace labeled_cloud;
using Eigen::Vector3f;
using mrpt::obs::CObservationComment;
using semantic_types::ClassId;
using semantic_types::ClassTable;

TEST(LabeledClouds, areTakenAsTheyAreExceptUnusablePoints) {
  CObservationLabeledCloud obs;
  obs.sensorPose = mrpt::poses::CPose3D(0, 0, 2, 0, 0, 0);
  obs.cloud.points = {{1, 2, 3}, {NAN, 0, 0}, {0, 0, 0}, {0, INFINITY, 0}, {4, 5, 6}};
  obs.cloud.classes = {3, 1, 1, 1, 0};
  const auto scan = convert(obs);
  EXPECT_EQ(scan.cloud.points, (std::vector<Vector3f>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(scan.cloud.classes, (std::vector<ClassId>{3, 0}));
  EXPECT_EQ(scan.counts.invalid, 3u);
  EXPECT_EQ(scan.counts.labeled, 1u);
  EXPECT_EQ(scan.T_robot_sensor.z(), 2);
}

TEST(LabeledClouds, classesGoByTheirNames) {
  CObservationLabeledCloud obs;
  obs.cloud.points = {{1, 0, 0}, {2, 0, 0}};
  obs.cloud.classes = {1, 2};
  obs.classNames = {"c", "a", "unheard-of"};
  EXPECT_EQ(convert(obs).cloud.classes, (std::vector<ClassId>{3, 1}));
  obs.cloud.probabilities = {0.25f, 0.75f, 0, 1, 0, 0};
  EXPECT_EQ(convert(obs).cloud.probabilities, (std::vector<float>{0.75f, 0, 0.25f, 0, 0, 1}));
  EXPECT_EQ(convert(obs).counts.labeled, 2u);
  obs.cloud.classes = {1, 3};
  EXPECT_TRUE(contains(errorConverting(obs), "its class 'unheard-of' is not in the table"));
}

TEST(LabeledClouds, aClassBeyondTheTableIsNamed) {
  CObservationLabeledCloud obs;
  obs.cloud.points = {{1, 0, 0}};
  obs.cloud.classes = {4};
  EXPECT_TRUE(contains(errorConverting(obs), "its class 4 is not one of 1..3"));
}

TEST(LabeledClouds, aSensorsPoseThatIsNotFiniteIsRefused) {
  CObservationLabeledCloud obs;
  obs.cloud.points = {{1, 0, 0}};
  obs.sensorPose = mrpt::poses::CPose3D(0, 0, 0, NAN, 0, 0);
  EXPECT_TRUE(contains(errorConverting(obs), "the sensor's pose is not finite"));
}

TEST(UnlabeledClouds, countForOccupancyOnly) {
  auto map = mrpt::maps::CSimplePointsMap::Create();
  map->insertPoint(1, 2, 3);
  map->insertPoint(0, 0, 0);
  map->insertPoint(NAN, 2, 3);
  mrpt::obs::CObservationPointCloud obs;
  EXPECT_TRUE(contains(errorConverting(obs), "it holds no point cloud"));
  obs.pointcloud = map;
  obs.sensorPose = mrpt::poses::CPose3D(5, 0, 0, 0, 0, 0);
  const auto scan = convert(obs);
  EXPECT_EQ(scan.cloud.points, (std::vector<Vector3f>{{1, 2, 3}}));
  EXPECT_EQ(scan.counts.invalid, 2u);
  EXPECT_EQ(scan.counts.labeled, 0u);
  EXPECT_EQ(scan.T_robot_sensor.x(), 5);
}

TEST(ColoredClouds, haveTheClassesOfTheTablesColorsUnlessTheyAreAPhotographs) {
  semantic_types::ClassTable table = tableOf({{"road", {128, 64, 129}}, {"car", {245, 150, 100}}});
  auto map = mrpt::maps::CColouredPointsMap::Create();
  const auto add = [&map](float x, float r, float g, float b) {
    const std::size_t i = map->size();
    map->resize(i + 1);
    map->setPointFast(i, x, 0, 0);
    map->setPointColor_fast(i, r / 255, g / 255, b / 255);
  };
  add(1, 245, 150, 100);
  add(2, 0, 0, 0);
  add(NAN, 245, 150, 100);
  add(3, 128, 64, 129);
  mrpt::obs::CObservationPointCloud obs;
  obs.pointcloud = map;
  const auto classes = [&] { return ScanConverter(table).convert(obs)->cloud.classes; };
  EXPECT_EQ(classes(), (std::vector<semantic_types::ClassId>{2, 0, 1}));
  add(4, 128, 64, 130);
  EXPECT_EQ(classes(), std::vector<semantic_types::ClassId>());
}

#if MSO_MRPT_AT_LEAST(2, 15, 0)

TEST(PointClouds, haveTheClassesOfTheirFieldLabel) {
  auto map = mrpt::maps::CGenericPointsMap::Create();
  map->registerField_uint16("label");
  map->registerField_float("t");
  const auto add = [&map](float x, std::uint16_t label, float time) {
    map->insertPointFast(x, 0, 0);
    map->insertPointField_uint16("label", label);
    map->insertPointField_float("t", time);
  };
  add(1, 40, 0.25f);
  add(NAN, 10, 0);
  add(2, 0, 0.5f);
  add(3, 10, 0.75f);
  semantic_types::ClassTable table = tableOf({{"road", {128, 64, 129}}, {"car", {245, 150, 100}}});
  table.fold(40, 1);
  table.fold(10, 2);
  mrpt::obs::CObservationPointCloud obs;
  obs.pointcloud = map;
  const auto scan = *ScanConverter(table).convert(obs);
  EXPECT_EQ(scan.cloud.classes, (std::vector<ClassId>{1, 0, 2}));
  EXPECT_EQ(scan.times, (std::vector<float>{0.25f, 0.5f, 0.75f}));
  add(4, 10, 1.7e9f);
  EXPECT_EQ(ScanConverter(table).convert(obs)->times, std::vector<float>()) << "not after the scan";
  add(4, 41, 0);
  EXPECT_THROW(ScanConverter(table).convert(obs), std::runtime_error);
}

TEST(PointClouds, haveTheClassesOfTheColorsAmongTheirFields) {
  auto map = mrpt::maps::CGenericPointsMap::Create();
  for (const char* name : {"color_r", "color_g", "color_b"}) map->registerField_uint8(name);
  map->insertPointFast(1, 0, 0);
  map->insertPointField_uint8("color_r", 245);
  map->insertPointField_uint8("color_g", 150);
  map->insertPointField_uint8("color_b", 100);
  const semantic_types::ClassTable table = tableOf({{"car", {245, 150, 100}}});
  mrpt::obs::CObservationPointCloud obs;
  obs.pointcloud = map;
  EXPECT_EQ(ScanConverter(table).convert(obs)->cloud.classes, (std::vector<ClassId>{1}));
}

#elif MSO_MRPT_AT_LEAST(2, 14, 0)

TEST(PointClouds, haveTheTimesOfTheirPoints) {
  auto map = mrpt::maps::CPointsMapXYZIRT::Create();
  map->resize_XYZIRT(3, false, false, true);
  for (int i = 0; i < 3; ++i) {
    map->setPointFast(i, i == 1 ? NAN : i + 1.0f, 0, 0);
    (*map->getPointsBufferRef_timestamp())[i] = 0.01f * i;
  }
  mrpt::obs::CObservationPointCloud obs;
  obs.pointcloud = map;
  EXPECT_EQ(convert(obs).times, (std::vector<float>{0, 0.02f}));
}

#endif

TEST(UnlabeledClouds, withoutAllTheirCoordinatesAreRefused) {
  mrpt::obs::CObservationVelodyneScan scan;
  scan.sensorLabel = "velo";
  scan.point_cloud.x = {1, 2, 3, 4};
  scan.point_cloud.y = scan.point_cloud.z = {1, 2};
  EXPECT_TRUE(contains(errorConverting(scan), "its points have 4 x, 2 y and 2 z"));
}

TEST(UnlabeledClouds, rawVelodynePacketsAreUnpacked) {
  const std::filesystem::path file = "/usr/share/mrpt/datasets/test_velodyne_VLP16.rawlog";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs Debian's mrpt-common";
  RawlogReader reader(file);
  std::size_t scans = 0;
  while (const auto entry = reader.next())
    for (const auto& obs : entry->observations)
      if (dynamic_cast<const mrpt::obs::CObservationVelodyneScan*>(obs.get())) {
        ++scans;
        const auto scan = convert(*obs);
        EXPECT_GT(scan.counts.points, 10000u);
        ASSERT_EQ(scan.times.size(), scan.cloud.size());
        const auto [first, last] = std::minmax_element(scan.times.begin(), scan.times.end());
        EXPECT_NEAR(*first, 0, 1e-3);
        EXPECT_NEAR(*last, 0.1, 0.03) << "ten turns a second";
      }
  EXPECT_GT(scans, 0u);
}

TEST(LabeledClouds, pointsThatAreReturnsKeepTheirTimes) {
  CObservationLabeledCloud obs;
  obs.cloud.points = {{1, 0, 0}, {0, 0, 0}, {NAN, 0, 0}, {2, 0, 0}};
  obs.times = {0.1f, 0.2f, 0.3f, -0.4f};
  EXPECT_EQ(convert(obs).times, (std::vector<float>{0.1f, -0.4f}));
}

TEST(EmptyBeams, endBeyondTheRangeThatTheObservationStatesIfTheyAreToCarve) {
  CObservationLabeledCloud cloud;
  cloud.cloud.points = {{1, 0, 0}, {0, 5, 0}, {0, 0, 0}, {2, 0, 0}};
  cloud.cloud.classes = {3, 1, 1, 2};
  cloud.emptyFrom = 5;
  mrpt::obs::CObservation2DRangeScan laser;
  laser.aperture = float(M_PI);
  laser.maxRange = 5;
  laser.resizeScan(4);
  const float ranges[] = {1, 0, INFINITY, 3};  // the second one is lost
  for (int i = 0; i < 4; ++i)
    laser.setScanRange(i, ranges[i]), laser.setScanRangeValidity(i, i % 3 == 0);
  ScanConverterOptions carving;
  carving.emptyCarves = true;
  for (const mrpt::obs::CObservation* observation :
       std::initializer_list<const mrpt::obs::CObservation*>{&cloud, &laser}) {
    const auto without = convert(*observation), with = convert(*observation, carving);
    EXPECT_EQ(without.cloud.size(), 2u);
    EXPECT_TRUE(without.empty.empty());
    EXPECT_EQ(with.cloud.points, without.cloud.points);
    EXPECT_EQ(with.emptyFrom, 5);
    ASSERT_EQ(with.empty.size(), 1u);
    EXPECT_GT(with.empty[0].norm(), 5);
    const Vector3f towards =
        observation == &cloud ? Vector3f(0, 1, 0) : Vector3f(cosf(M_PI / 6), sinf(M_PI / 6), 0);
    EXPECT_LT((with.empty[0].normalized() - towards).norm(), 1e-5);
  }
  const auto both = convert(cloud, carving).withEmpty();
  EXPECT_EQ(both.size(), 3u);
  EXPECT_EQ(both.classes, (std::vector<ClassId>{3, 2, 0}));
}

TEST(UnlabeledClouds, laserScansLieInTheSensorsPlaneAsMrptItselfPutsThem) {
  for (const bool rightToLeft : {true, false}) {
    mrpt::obs::CObservation2DRangeScan obs;
    obs.aperture = 1.5f;
    obs.maxRange = 10;
    obs.rightToLeft = rightToLeft;
    obs.sensorPose = mrpt::poses::CPose3D(5, 1, 2, 0.3, 0.2, 0.1);
    obs.resizeScan(4);
    const float ranges[] = {1, 2, 10, 3};
    for (int i = 0; i < 4; ++i) obs.setScanRange(i, ranges[i]), obs.setScanRangeValidity(i, i != 2);
    const auto scan = convert(obs);
    EXPECT_EQ(scan.counts.invalid, 1u);
    EXPECT_EQ(scan.counts.labeled, 0u);
    mrpt::maps::CSimplePointsMap map;
    map.insertionOptions.minDistBetweenLaserPoints = 0;
    const auto T_sensor_robot = -obs.sensorPose;
    map.loadFromRangeScan(obs, T_sensor_robot);
    ASSERT_EQ(map.size(), scan.cloud.size());
    for (std::size_t i = 0; i < map.size(); ++i) {
      Vector3f expected;
      map.getPoint(i, expected.x(), expected.y(), expected.z());
      EXPECT_LT((scan.cloud.points[i] - expected).norm(), 1e-5) << i;
    }
  }
}

TEST(ScanConverter, otherObservationsAreNoneOfItsBusiness) {
  const mrpt::obs::CObservationComment comment;
  EXPECT_FALSE(ScanConverter::accepts(comment));
  EXPECT_FALSE(ScanConverter(abc()).convert(comment));
}

TEST(PointSources, ofOthersAreTakenWithTheirClassesByName) {
  struct Notes : PointSource {
    bool accepts(const mrpt::obs::CObservation& o) const override {
      return o.sensorLabel == "dictated" && dynamic_cast<const CObservationComment*>(&o);
    }
    NamedCloud read(const mrpt::obs::CObservation& o) const override {
      NamedCloud named;
      std::istringstream text(dynamic_cast<const CObservationComment&>(o).text);
      for (std::string name; text >> name;) {
        Vector3f point;
        text >> point.x() >> point.y() >> point.z();
        named.cloud.points.push_back(point);
        named.classNames.push_back(name);
        named.cloud.classes.push_back(static_cast<ClassId>(named.classNames.size()));
      }
      return named;
    }
  };
  addPointSource(std::make_shared<Notes>());
  CObservationComment comment;
  comment.sensorLabel = "dictated";
  comment.text = "c 1 2 3  a 4 5 6  b 0 0 0";
  ASSERT_TRUE(ScanConverter::accepts(comment));
  const auto scan = convert(comment);
  EXPECT_EQ(scan.cloud.points, (std::vector<Vector3f>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(scan.cloud.classes, (std::vector<ClassId>{3, 1}));
  EXPECT_EQ(scan.counts.invalid, 1u);
  comment.text = "unheard-of 1 2 3";
  EXPECT_TRUE(contains(errorConverting(comment), "its class 'unheard-of' is not in the table"));
}

TEST(ScanConverter, badOptionsAreNamed) {
  ScanConverterOptions options;
  options.decimation = 0;
  EXPECT_TRUE(contains(errorOf([&] { ScanConverter(abc(), options); }), "decimation is 0"));
  options = {};
  options.flyingPixelThreshold = -0.5;
  EXPECT_TRUE(
      contains(errorOf([&] { ScanConverter(abc(), options); }), "flying_pixel_threshold is -0.5"));
}
