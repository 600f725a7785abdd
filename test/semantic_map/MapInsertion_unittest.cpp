#include <gtest/gtest.h>
#include <mrpt/maps/CMetricMapEvents.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/system/CObserver.h>

#include <algorithm>

#include "SmallMaps.h"
#include "TemporaryFolder.h"

using mrpt::poses::CPose3D;
using semantic_map::CSemanticOctoMap;
using semantic_octree::CellState;
using semantic_types::kNoClass;
using Status = CellState::Status;

namespace {

/** At (10, 0), turned left by a right angle, so that its x axis is the map's y axis. */
const CPose3D kRobot(10, 0, 0, M_PI / 2, 0, 0);
/** 2 m above the robot, looking straight down: its x axis points down, z forward. */
const CPose3D kSensor(0, 0, 2, 0, M_PI / 2, 0);
/** In the sensor's frame (x, y, z), and by hand (z, y, 2 - x) in the robot's, (10 - y, z, 2 - x) in
 * the map's. */
const Eigen::Vector3f kPoint(1.03f, 0.53f, 0.23f);

/** The voxel of kPoint is occupied, the beam to it free, and nothing else anywhere. */
void expectOnlyThePoint(const CSemanticOctoMap& map, semantic_types::ClassId id) {
  const auto& tree = map.tree();
  const CellState state = tree.query(10 - 0.53, 0.23, 2 - 1.03);
  EXPECT_EQ(state.status, Status::Occupied);
  EXPECT_EQ(state.likeliestClass, id);
  EXPECT_EQ(tree.query(10 - 0.53 / 2, 0.23 / 2, 2 - 1.03 / 2).status, Status::Free);
  EXPECT_EQ(tree.query(10, 0, 0.5).status, Status::Unknown);
  int occupied = 0;
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
    occupied += tree.isNodeOccupied(*leaf);
  EXPECT_EQ(occupied, 1);
}

CSemanticOctoMap quietMap() {
  CSemanticOctoMap map(0.1, threeClasses());
  map.logger().logging_enable_console_output = false;
  return map;
}

/** A camera of 21 x 21 pixels, f = 100, that sees one point: pixel (8, 6), 2 m away. */
mrpt::obs::CObservation3DRangeScan onePixel() {
  mrpt::obs::CObservation3DRangeScan scan;
  scan.cameraParams.ncols = scan.cameraParams.nrows = 21;
  scan.cameraParams.setIntrinsicParamsFromValues(100, 100, 10, 10);
  scan.hasRangeImage = true;
  scan.rangeImage_setSize(21, 21);
  scan.rangeImage.fill(0);
  scan.rangeImage(8, 6) = 2000;
  return scan;
}

void expectRefused(CSemanticOctoMap& map, const mrpt::obs::CObservation& observation,
                   const std::string& reason, const CPose3D& pose = {}) {
  const std::string before = bytesOf(map);
  EXPECT_FALSE(map.insertObservation(observation, pose));
  EXPECT_FALSE(map.lastInsertion().inserted());
  EXPECT_TRUE(contains(map.lastInsertion().refusal, reason));
  EXPECT_TRUE(bytesOf(map) == before);
}

}  // namespace

TEST(MapInsertion, pixelsWithoutAReturnCarveUpToTheCamerasRangeOnlyIfAskedTo) {
  auto scan = onePixel();
  scan.maxRange = 3;
  auto map = quietMap();
  ASSERT_TRUE(map.insertObservation(scan));
  EXPECT_EQ(map.tree().query(2.5, 0, 0).status, Status::Unknown);
  map.clear();
  map.insertionOptions.conversion.emptyCarves = true;
  ASSERT_TRUE(map.insertObservation(scan));
  EXPECT_EQ(map.tree().query(2.5, 0, 0).status, Status::Free);
  EXPECT_EQ(map.tree().query(2.85, 0, 0).status, Status::Free);
  int occupied = 0;
  for (auto leaf = map.tree().begin_leafs(), end = map.tree().end_leafs(); leaf != end; ++leaf) {
    occupied += map.tree().isNodeOccupied(*leaf);
    EXPECT_LT(leaf.getCoordinate().norm(), 3.1);
  }
  EXPECT_EQ(occupied, 1);
  scan.rangeImage.fill(0);
  EXPECT_TRUE(map.insertObservation(scan)) << "nothing at all is near";
}

TEST(MapInsertion, pointsLandWhereTheirSensorSawThem) {
  auto labeled = labeledPoints({kPoint}, {2});
  mrpt::obs::CObservationPointCloud cloud;
  const auto points = mrpt::maps::CSimplePointsMap::Create();
  points->insertPoint(kPoint.x(), kPoint.y(), kPoint.z());
  cloud.pointcloud = points;
  mrpt::obs::CObservationVelodyneScan velodyne;
  velodyne.point_cloud.x = {kPoint.x()};
  velodyne.point_cloud.y = {kPoint.y()};
  velodyne.point_cloud.z = {kPoint.z()};
  for (mrpt::obs::CObservation* observation :
       std::initializer_list<mrpt::obs::CObservation*>{&labeled, &cloud, &velodyne}) {
    CSemanticOctoMap map = quietMap();
    observation->setSensorPose(kSensor);
    EXPECT_TRUE(map.insertObservation(*observation, kRobot));
    const bool hasLabels = observation == &labeled;
    expectOnlyThePoint(map, hasLabels ? 2 : kNoClass);
    EXPECT_EQ(map.lastInsertion().conversion.labeled, hasLabels ? 1u : 0u);
    EXPECT_EQ(map.lastInsertion().map.hitVoxels, 1u);
  }
}

TEST(MapInsertion, aDepthImageLandsWhereItsCameraSawIt) {
  for (const bool labeled : {false, true}) {
    CSemanticOctoMap map = quietMap();
    auto scan = onePixel();
    scan.sensorPose = CPose3D(0, 0, 2.53, 0, M_PI / 2, 0);
    if (labeled) {
      const auto labels = std::make_shared<mrpt::obs::TPixelLabelInfo<1>>();
      labels->setSize(21, 21);
      labels->setLabel(8, 6, 5);
      labels->setLabelName(5, "wall");
      scan.pixelLabels = labels;
    }
    EXPECT_TRUE(map.insertObservation(scan, kRobot));
    // The pixel's ray by hand: x = 2, y = (10 - 6) / 100 x, z = (10 - 8) / 100 x.
    const CellState state = map.tree().query(10 - 0.08, 0.04, 2.53 - 2);
    EXPECT_EQ(state.status, Status::Occupied);
    EXPECT_EQ(state.likeliestClass, labeled ? 3 : kNoClass);
    EXPECT_EQ(map.lastInsertion().conversion.labeled, labeled ? 1u : 0u);
    EXPECT_EQ(map.lastInsertion().conversion.invalid, 21u * 21u - 1u);
  }
}

TEST(MapInsertion, arrivalsAndClearingAreAnnouncedToObservers) {
  struct Counter : mrpt::system::CObserver {
    int insertions = 0, clearings = 0;
    void OnEvent(const mrpt::system::mrptEvent& e) override {
      insertions += e.isOfType<mrpt::maps::mrptEventMetricMapInsert>();
      clearings += e.isOfType<mrpt::maps::mrptEventMetricMapClear>();
    }
  } counter;
  CSemanticOctoMap map = quietMap();
  counter.observeBegin(map);
  map.insertObservation(labeledPoints({kPoint}, {2}));
  map.insertObservation(labeledPoints({kPoint}, {9}));
  map.insertObservation(mrpt::obs::CObservationOdometry());
  EXPECT_EQ(counter.insertions, 1);
  map.clear();
  EXPECT_EQ(counter.clearings, 1);
  EXPECT_TRUE(map.isEmpty());
}

TEST(MapInsertion, whatIsRefusedSaysWhyAndLeavesTheMap) {
  CSemanticOctoMap map = quietMap();
  fill(map);
  expectRefused(map, labeledPoints({kPoint}, {9}), "class");
  expectRefused(map, labeledPoints({}, {}), "no point");
  expectRefused(map, labeledPoints({{NAN, 0, 0}}, {1}), "no point");
  expectRefused(map, mrpt::obs::CObservation3DRangeScan(), "range image");
  expectRefused(map, mrpt::obs::CObservationPointCloud(), "point cloud");
  expectRefused(map, mrpt::obs::CObservationOdometry(), "CObservationOdometry");
  expectRefused(map, labeledPoints({kPoint}, {1}), "robot is not finite",
                CPose3D(NAN, 0, 0, 0, 0, 0));
  expectRefused(map, labeledPoints({kPoint}, {1}), "outside", CPose3D(1e6, 0, 0, 0, 0, 0));
}

TEST(MapInsertion, aReasonIsLoggedOnceUntilItChanges) {
  CSemanticOctoMap map = quietMap();
  map.logger().logging_enable_keep_record = true;
  const auto warnings = [&map] {
    const std::string log = map.logger().getLogAsString();
    return std::count(log.begin(), log.end(), '\n');
  };
  const auto empty = labeledPoints({}, {});
  map.insertObservation(mrpt::obs::CObservationOdometry());
  EXPECT_EQ(warnings(), 0);
  map.insertObservation(empty);
  map.insertObservation(empty);
  EXPECT_EQ(warnings(), 1);
  map.insertObservation(labeledPoints({kPoint}, {9}));
  EXPECT_EQ(warnings(), 2);
}

TEST(MapInsertion, theFilterCanChangeWhileTheMapIsEmptyOnly) {
  CSemanticOctoMap map = quietMap();
  map.insertionOptions.filter.hitProbability = 0.8;
  EXPECT_TRUE(map.insertObservation(labeledPoints({kPoint}, {1})));
  EXPECT_EQ(map.tree().filterParameters().hitProbability, 0.8);
  map.insertionOptions.filter.hitProbability = 0.7;
  expectRefused(map, labeledPoints({kPoint}, {1}), "filter parameters");
  map.clear();
  EXPECT_TRUE(map.insertObservation(labeledPoints({kPoint}, {1})));
}

TEST(MapInsertion, whatLabelsSayCanChangeBetweenObservations) {
  CSemanticOctoMap map(0.2, threeClasses());
  auto unsure = labeledPoints({{4, 1, 0}}, {});
  unsure.cloud.probabilities = {0.6f, 0.3f, 0.1f};
  map.insertObservation(unsure);
  EXPECT_EQ(map.lastInsertion().conversion.labeled, 1u);
  map.insertionOptions.conversion.labels.minConfidence = 0.9;
  map.insertObservation(unsure);
  EXPECT_EQ(map.lastInsertion().conversion.labeled, 0u);
}

TEST(MapInsertion, scanOptionsHold) {
  CSemanticOctoMap map = quietMap();
  map.insertionOptions.scan.maxRange = 1;
  EXPECT_TRUE(map.insertObservation(labeledPoints({{3.05f, 0.05f, 0.05f}}, {1})));
  EXPECT_EQ(map.tree().query(0.55, 0.01, 0.01).status, Status::Free);
  EXPECT_EQ(map.tree().query(3.05, 0.05, 0.05).status, Status::Unknown);
}
