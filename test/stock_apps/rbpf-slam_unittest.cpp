#include "LaserMapCheck.h"
#include "StockApps.h"

namespace {

class RbpfSlam : public StockApps {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_APP("rbpf-slam");
    SKIP_WITHOUT(std::string("/usr/share/mrpt/datasets/") + kLaserRawlog, "mrpt-common");
  }
  CommandRun slam() const {
    return run("rbpf-slam config/stock-apps/rbpf-slam.ini '" + shortRawlog(kLaserRawlog, 60) + "'",
               Plugin::Preloaded);
  }
};

}  // namespace

TEST_F(RbpfSlam, eachParticleBuildsWeighsAndCopiesASemanticOctree) {
  const CommandRun slammed = slam();
  ASSERT_EQ(slammed.status, 0) << slammed.output;
  const auto map = mapIn("rbpf-slam-output");
  ASSERT_TRUE(map) << slammed.output;
  const auto check =
      checkLaserMap(*map, folder / "rbpf-slam-output/finalMap_mrpt__maps__CSimplePointsMap_00.txt",
                    folder / "rbpf-slam-output/log_odometry_path.txt");
  EXPECT_GT(check.pointsInOccupied, 0.8);
  EXPECT_GT(check.occupiedAtPoints, 0.98);
}
