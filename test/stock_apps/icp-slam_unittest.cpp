#include "LaserMapCheck.h"
#include "StockApps.h"

namespace {

class IcpSlam : public StockApps {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_APP("icp-slam");
    SKIP_WITHOUT(std::string("/usr/share/mrpt/datasets/") + kLaserRawlog, "mrpt-common");
    rawlog = shortRawlog(kLaserRawlog, 60);
  }
  CommandRun slam(const std::string& ini, Plugin plugin) const {
    return run("icp-slam '" + ini + "' '" + rawlog + "'", plugin);
  }
  std::string rawlog;
};

}  // namespace

TEST_F(IcpSlam, aRealLaserScannerMakesASemanticOctree) {
  const CommandRun slammed = slam("config/stock-apps/icp-slam.ini", Plugin::Preloaded);
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
  const CommandRun slammed = slam("config/stock-apps/icp-slam.ini", Plugin::Absent);
  EXPECT_EQ(slammed.status != 0, kMrptRefusesUnknownMaps) << slammed.output;
  EXPECT_EQ(contains(slammed.output, "semanticOctoMap_count"), kMrptRefusesUnknownMaps);
  EXPECT_FALSE(mapIn("icp-slam-output"));
  EXPECT_NE(std::filesystem::exists(folder / "icp-slam-output/_finalmap_.simplemap"),
            kMrptRefusesUnknownMaps);
}

TEST_F(IcpSlam, aMisspelledOptionStopsItWithTheReason) {
  const std::string ini =
      configWith("icp-slam.ini", "MappingApplication_semanticOctoMap_00_insertOpts", "maxRnage=9");
  const CommandRun slammed = slam(ini, Plugin::Preloaded);
  EXPECT_NE(slammed.status, 0);
  EXPECT_TRUE(contains(slammed.output, "maxRnage")) << slammed.output;
}
