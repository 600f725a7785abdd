#include "LaserMapCheck.h"
#include "StockApps.h"

namespace {

class RbpfSlam : public StockApps {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_APP("rbpf-slam");
    SKIP_WITHOUT(std::string("/usr/share/mrpt/datasets/") + kLaserRawlog, "mrpt-common");
  }
  CommandRun slam(Plugin plugin) const {
    return run("rbpf-slam config/stock-apps/rbpf-slam.ini '" + shortRawlog(kLaserRawlog, 60) + "'",
               plugin);
  }
};

}  // namespace

TEST_F(RbpfSlam, eachParticleBuildsWeighsAndCopiesASemanticOctree) {
  const CommandRun slammed = slam(Plugin::Preloaded);
  ASSERT_EQ(slammed.status, 0) << slammed.output;
  const auto map = mapIn("rbpf-slam-output");
  ASSERT_TRUE(map) << slammed.output;
  const auto check =
      checkLaserMap(*map, folder / "rbpf-slam-output/finalMap_mrpt__maps__CSimplePointsMap_00.txt",
                    folder / "rbpf-slam-output/log_odometry_path.txt");
  EXPECT_GT(check.pointsInOccupied, 0.8);
  EXPECT_GT(check.occupiedAtPoints, 0.98);
}

TEST_F(RbpfSlam, withoutThePluginThereIsNoSuchMap) {
  EXPECT_EQ(slam(Plugin::Absent).status != 0, kMrptRefusesUnknownMaps);
  EXPECT_FALSE(mapIn("rbpf-slam-output"));
}
