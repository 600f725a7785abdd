#include <gtest/gtest.h>
#include <semantic_octree/TreeFile.h>

#include <algorithm>
#include <set>

#include "../semantic_planning/PaintedWorld.h"
#include "CsvTable.h"
#include "RunProgram.h"
#include "TemporaryFolder.h"

namespace {

using Rows = std::vector<std::map<std::string, std::string>>;

class PlanningStudy : public FolderTest {
 protected:
  void SetUp() override {
    PaintedWorld world;  // grass with a road around a corner, and mud
    world.floor(-12, 12, -12, 12, PaintedWorld::Grass);
    world.floor(-10, -6, -12, 10, PaintedWorld::Road);
    world.floor(-10, 12, 6, 10, PaintedWorld::Road);
    world.floor(-3, 3, -6, 3, PaintedWorld::Mud);
    saveTree(world.map(), path("map.semantic"));
    folder.write("order.yaml", "best_to_worst: [road, grass, mud, unknown]\n");
    folder.write("weights.yaml", "relevant: {road: 1}\nalpha: 0.001\nname: roads\n");
  }

  ProgramRun study(const Words& more, const std::string& output = "study.csv",
                   const std::string& order = "order.yaml") const {
    Words arguments = joined(
        {path("map.semantic"), "-f", "--order", path(order), "--weights", path("weights.yaml"),
         "--output", path(output), "--instances", "4", "--vertices", "120"},
        more);
    if (std::find(more.begin(), more.end(), "--min-distance") == more.end())
      arguments.insert(arguments.end(), {"--min-distance", "8"});
    return runProgram("planning-study", arguments);
  }

  /** All but the times. */
  Rows rows(const std::string& output = "study.csv") const {
    const auto table = csvTable(folder.read(output));
    Rows result;
    for (std::size_t r = 1; r < table.size(); ++r) {
      std::map<std::string, std::string> row;
      for (std::size_t i = 0; i < table[0].size(); ++i)
        if (table[0][i].find("[ms]") == std::string::npos) row[table[0][i]] = table[r].at(i);
      result.push_back(row);
    }
    return result;
  }

  void expectRefused(const ProgramRun& run, const std::string& part) const {
    EXPECT_NE(run.status, 0);
    EXPECT_TRUE(contains(run.errors, part));
    EXPECT_FALSE(std::filesystem::exists(folder / "study.csv"));
  }
};

}  // namespace

TEST_F(PlanningStudy, eachTaskIsPlannedWithThreeGraphsAndTwoJudgments) {
  ASSERT_EQ(study({}).status, 0);
  std::set<std::string> searches;
  for (const auto& row : rows()) {
    searches.insert(row.at("instance") + row.at("judgment") + row.at("graph"));
    EXPECT_LE(std::stoi(row.at("vertices")), 120 + 2);
    EXPECT_LE(std::stoi(row.at("edges")), 5 * 120 + 2 * 20 + 1);
    if (row.at("found") == "1") {
      EXPECT_GE(std::stod(row.at("length [m]")), 8);
      EXPECT_LE(std::stod(row.at("off the best [m]")), std::stod(row.at("length [m]")) + 1e-6);
    }
  }
  EXPECT_EQ(searches.size(), 4u * 3 * 2);
}

TEST_F(PlanningStudy, equalSeedsGiveEqualResultsApartFromTimes) {
  ASSERT_EQ(study({"--seed", "5"}, "first.csv").status, 0);
  ASSERT_EQ(study({"--seed", "5"}, "second.csv").status, 0);
  ASSERT_EQ(study({"--seed", "6"}, "other.csv").status, 0);
  EXPECT_EQ(rows("first.csv"), rows("second.csv"));
  EXPECT_NE(rows("first.csv"), rows("other.csv"));
}

TEST_F(PlanningStudy, badInputIsRefusedAndNothingWritten) {
  folder.write("strange.yaml", "best_to_worst: [road, lava]\n");
  expectRefused(study({}, "study.csv", "strange.yaml"), "lava");
  expectRefused(study({"--solution", "none"}), "unknown solution 'none'");
  expectRefused(study({"--vertices", "0"}), "vertices");
  expectRefused(study({"--min-distance", "500"}), "500");
}
