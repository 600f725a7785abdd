#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/Rawlogs.h>
#include <mrpt_compat/Drawing.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_types/ClassTable.h>

#include <fstream>

#include "StockApps.h"

namespace {

class IcpSlam : public StockApps {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_APP("icp-slam");
    SKIP_WITHOUT(std::string("/usr/share/mrpt/datasets/") + kLaserRawlog, "mrpt-common");
    rawlog = shortRawlog(kLaserRawlog, 60);
  }
  ProgramRun slam(const std::string& ini, Plugin plugin) const {
    return run("icp-slam '" + ini + "' '" + rawlog + "'", plugin);
  }
  std::string rawlog;
};

TEST_F(IcpSlam, aRealLaserScannerMakesASemanticOctree) {
  const ProgramRun slammed = slam("config/stock-apps/icp-slam.ini", Plugin::Preloaded);
  ASSERT_EQ(slammed.status, 0) << slammed.output;
  const auto map = mapIn("icp-slam-output");
  ASSERT_TRUE(map) << slammed.output;
  EXPECT_EQ(map->getResolution(), 0.1);
  const auto check = checkLaserMap(
      *map, folder / "icp-slam-output/_finalmaps_.txt_mrpt__maps__CSimplePointsMap_00.txt",
      folder / "icp-slam-output/log_estimated_path.txt");
  EXPECT_GT(check.pointsInOccupied, 0.8);
  EXPECT_GT(check.occupiedAtPoints, 0.98);
  EXPECT_GT(check.pathInFree, 0.98);
  // The robot drives 11 m down the corridor (as MRPT's own test of this rawlog knows).
  EXPECT_EQ(map->query(4, -5, 0.3).status, semantic_octree::CellState::Status::Free);
}

TEST_F(IcpSlam, withoutThePluginThereIsNoSuchMapWhichOnlyNewerReleasesSay) {
  const ProgramRun slammed = slam("config/stock-apps/icp-slam.ini", Plugin::Absent);
  EXPECT_EQ(slammed.status != 0, kMrptRefusesUnknownMaps) << slammed.output;
  EXPECT_EQ(contains(slammed.output, "semanticOctoMap_count"), kMrptRefusesUnknownMaps);
  EXPECT_FALSE(mapIn("icp-slam-output"));
  EXPECT_NE(std::filesystem::exists(folder / "icp-slam-output/_finalmap_.simplemap"),
            kMrptRefusesUnknownMaps);
}

TEST_F(IcpSlam, whatMrptWouldLeaveOutInSilenceStopsItWithTheReason) {
  for (const std::string section : {"00_insertionOpts", "7_insertOpts"}) {
    std::filesystem::copy_file(folder / "config/stock-apps/icp-slam.ini", folder / "icp-slam.ini",
                               std::filesystem::copy_options::overwrite_existing);
    std::ofstream(folder / "icp-slam.ini", std::ios::app)
        << "\n[MappingApplication_semanticOctoMap_" << section << "]\n";
    const ProgramRun slammed = slam("icp-slam.ini", Plugin::Preloaded);
    EXPECT_NE(slammed.status, 0) << section;
    EXPECT_TRUE(contains(slammed.output, section)) << slammed.output;
  }
}

class RbpfSlam : public StockApps {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_APP("rbpf-slam");
    SKIP_WITHOUT(std::string("/usr/share/mrpt/datasets/") + kLaserRawlog, "mrpt-common");
  }
};

TEST_F(RbpfSlam, eachParticleBuildsWeighsAndCopiesASemanticOctree) {
  const ProgramRun slammed =
      run("rbpf-slam config/stock-apps/rbpf-slam.ini '" + shortRawlog(kLaserRawlog, 60) + "'",
          Plugin::Preloaded);
  ASSERT_EQ(slammed.status, 0) << slammed.output;
  const auto map = mapIn("rbpf-slam-output");
  ASSERT_TRUE(map) << slammed.output;
  const auto check =
      checkLaserMap(*map, folder / "rbpf-slam-output/finalMap_mrpt__maps__CSimplePointsMap_00.txt",
                    folder / "rbpf-slam-output/log_odometry_path.txt");
  EXPECT_GT(check.pointsInOccupied, 0.8);
  EXPECT_GT(check.occupiedAtPoints, 0.98);
}

class Observations2Map : public StockApps {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_APP("observations2map");
    ASSERT_TRUE(villageFrames(2).saveToFile((folder / "village.simplemap").string()));
    std::filesystem::create_directory(folder / "out");
  }
};

/** The map that the application makes, made without it. */
semantic_octree::SemanticOcTree expectedMap() {
  semantic_map::CSemanticOctoMap map(
      0.2, semantic_types::loadClassTable(MSO_SOURCE_DIR "/config/classes/synthetic.yaml"));
  map.insertionOptions.scan.maxRange = 30;
  map.insertionOptions.conversion.flyingPixelThreshold = 0.02;
  map.loadFromSimpleMap(villageFrames(2));
  return map.tree();
}

/** Share of the first scan's labels that the map says too, at the places of their points. */
double shareOfLabelsIn(const semantic_octree::SemanticOcTree& map) {
  const auto frames = villageFrames(1);
  const auto cloud =
      frames.begin()->sf->getObservationByClass<labeled_cloud::CObservationLabeledCloud>();
  const auto T_map_sensor = frames.begin()->pose->getMeanVal() + cloud->sensorPose;
  double same = 0, all = 0;
  for (std::size_t i = 0; i < cloud->cloud.size(); ++i) {
    const auto& p = cloud->cloud.points[i];
    const auto at = T_map_sensor.composePoint({p.x(), p.y(), p.z()});
    if (p.norm() > 29 || cloud->cloud.classes[i] == semantic_types::kNoClass) continue;
    ++all;
    same += map.query(at.x, at.y, at.z).likeliestClass == cloud->cloud.classes[i];
  }
  return all > 1000 ? same / all : 0;
}

TEST_F(Observations2Map, theMapIsThatOfTheLibraryBitForBitAndInTheScene) {
  const ProgramRun made =
      run("observations2map config/stock-apps/observations2map.ini village.simplemap out/map",
          Plugin::Preloaded);
  ASSERT_EQ(made.status, 0) << made.output;
  const auto map = mapIn("out");
  ASSERT_TRUE(map) << made.output;
  EXPECT_TRUE(*map == expectedMap());
  EXPECT_GT(map->getNumLeafNodes(), 10000u);
  EXPECT_GT(shareOfLabelsIn(*map), 0.9);
  mrpt_compat::Scene scene;
  ASSERT_TRUE(
      scene.loadFromFile((folder / "out/map_semantic_map__CSemanticOctoMap_00.3Dscene").string()));
  const auto voxels = scene.getByClass<mrpt_compat::drawing::CSetOfObjects>()
                          ->getByClass<mrpt_compat::drawing::COctoMapVoxels>();
  ASSERT_TRUE(voxels);
  EXPECT_GT(voxels->getVoxelCount(mrpt_compat::drawing::VOXEL_SET_OCCUPIED), 1000u);
}

using labeled_cloud::CObservationLabeledCloud;

class RawlogEdit : public StockApps {
 protected:
  void SetUp() override { SKIP_WITHOUT_APP("rawlog-edit"); }
  ProgramRun edit(const std::string& arguments) const {
    return run("rawlog-edit -p " + kPlugin + ' ' + arguments);
  }
};

std::vector<mrpt::obs::CObservation::Ptr> observationsOf(const std::filesystem::path& file) {
  std::vector<mrpt::obs::CObservation::Ptr> all;
  labeled_cloud::RawlogReader reader(file);
  while (const auto entry = reader.next())
    all.insert(all.end(), entry->observations.begin(), entry->observations.end());
  return all;
}

const std::string kVillage = "rawlog-samples/village.rawlog";

}  // namespace

TEST_F(RawlogEdit, listsRawlogsWithLabeledCloudsAndDescribesThem) {
  const ProgramRun listed = edit("--info -i " + kVillage),
                   described = edit("--describe -i " + kVillage);
  EXPECT_EQ(listed.status, 0);
  EXPECT_TRUE(contains(listed.output, "Overall number of objects         : 72"));
  EXPECT_TRUE(contains(listed.output, "LIDAR /     24"));
  EXPECT_TRUE(contains(described.output, "labeled_cloud::CObservationLabeledCloud"));
  EXPECT_TRUE(contains(described.output, "road: ")) << described.output.substr(0, 3000);
}

TEST_F(RawlogEdit, cutsThemWithoutChangingABit) {
  if (!kRawlogEditDrops) GTEST_SKIP() << "rawlog-edit of this MRPT drops nothing";
  const ProgramRun cut =
      edit("--cut --from-index 3 --to-index 8 -i " + kVillage + " -o cut.rawlog");
  ASSERT_EQ(cut.status, 0) << cut.output;
  const auto before = observationsOf(folder / kVillage),
             after = observationsOf(folder / "cut.rawlog");
  ASSERT_EQ(after.size(), 6u);
  for (std::size_t i = 0; i < after.size(); ++i) {
    ASSERT_EQ(after[i]->GetRuntimeClass(), before[i + 3]->GetRuntimeClass());
    const auto a = std::dynamic_pointer_cast<CObservationLabeledCloud>(after[i]);
    const auto b = std::dynamic_pointer_cast<CObservationLabeledCloud>(before[i + 3]);
    if (!a) continue;
    EXPECT_EQ(a->cloud.points, b->cloud.points);
    EXPECT_EQ(a->cloud.classes, b->cloud.classes);
    EXPECT_EQ(a->classNames, b->classNames);
  }
}

TEST_F(RawlogEdit, withoutThePluginTheRawlogEndsAtTheFirstCloudAndTheStatusIsZero) {
  const ProgramRun listed = run("rawlog-edit --info -i " + kVillage);
  EXPECT_EQ(listed.status, 0);
  EXPECT_TRUE(contains(listed.output, "which is not registered"));
  EXPECT_TRUE(contains(listed.output, "Overall number of objects         : 2"));
}
