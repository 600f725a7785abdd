// Plans over maps that are larger than the memory for them.
#include <gtest/gtest.h>
#include <map_folders/MapFolder.h>
#include <map_operations/MapOperations.h>
#include <semantic_octree/TreeFile.h>

#include <nlohmann/json.hpp>

#include "../semantic_planning/PaintedWorld.h"
#include "RunProgram.h"
#include "ShellCommand.h"
#include "TemporaryFolder.h"

namespace {

using namespace semantic_octree;

/** A road of 600 m between lawns, with much air above it. */
class PlanOfALongRoad : public testing::Test {
 protected:
  static constexpr double kHalf = 300, kPiece = 20;  // m

  void SetUp() override {
    PaintedWorld world;
    for (double x = -kHalf; x < kHalf; x += kPiece) {
      world.floor(x, x + kPiece, -15, 15, PaintedWorld::Grass);
      world.floor(x, x + kPiece, -3, 3, PaintedWorld::Road);
      world.map({x + kPiece / 2, 0.05, 20});
    }
    const SemanticOcTree& map = world.map();
    saveTree(map, path("map.semantic"));
    StoredMap tiles(emptyLike(map), path("tiles"), {500, 12.8});
    copyTo(tiles.tree(), map);
    tiles.folder()->save();
    m_megabytes = static_cast<double>(map.memoryUsage()) / 1e6;
    folder.write("order.yaml", "best_to_worst: [road, grass, mud]\n");
  }

  std::string path(const std::string& name) const { return (folder / name).string(); }

  /** \return MB at its peak */
  double plan(const std::string& map, const std::string& start, const std::string& goal,
              const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {
        path(map),          "--start=" + start, "--goal=" + goal, "--order",
        path("order.yaml"), "--output",         path("out"),      "-f"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramRun run = runProgram("semantic-map-plan", arguments);
    EXPECT_EQ(run.status, 0) << run.errors;
    return static_cast<double>(run.peakKilobytes) / 1e3;
  }

  TemporaryFolder folder;
  double m_megabytes = 0;  ///< of the map in memory
};

}  // namespace

TEST_F(PlanOfALongRoad, keepsWithinABudgetOfATenthOfTheMap) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer takes memory of its own";
#endif
  const std::string budget = std::to_string(m_megabytes / 10);
  const std::vector<std::string> narrow = {"--corridor", "6", "--vertices", "2000"};
  std::vector<std::string> within = narrow;
  within.insert(within.end(), {"--memory", budget});
  const double least = plan("tiles", "-295,0,0", "-290,0,0", within);
  const double peak = plan("tiles", "-295,0,0", "295,0,0", within);
  const std::string way = folder.read("out/path.csv");
  const double whole = plan("map.semantic", "-295,0,0", "295,0,0", narrow);
  EXPECT_EQ(folder.read("out/path.csv"), way);
  // What the program takes anyhow, the budget, and 40 bytes for each column of the corridor.
  EXPECT_LT(peak, least + m_megabytes / 10 + 40e-6 * (2 * kHalf / 0.2) * (20 / 0.2));
  EXPECT_GT(whole, peak + 0.7 * m_megabytes);
}
