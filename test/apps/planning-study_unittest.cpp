#include <colored_graph/Edge.h>
#include <gtest/gtest.h>
#include <semantic_octree/TreeFile.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <sstream>

#include "../semantic_planning/PaintedWorld.h"
#include "CsvTable.h"
#include "RunProgram.h"
#include "TemporaryFolder.h"

using nlohmann::json;

namespace {

using Row = std::map<std::string, std::string>;

std::vector<long long> numbers(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<long long>(in), {}};
}

/** The way to plan that a row belongs to. */
std::string wayOf(const Row& row) {
  return row.at("judgment") + " " + row.at("graph") + " " + row.at("budget") + " " +
         row.at("memory");
}

class PlanningStudy : public testing::Test {
 protected:
  void SetUp() override {
    PaintedWorld world;  // grass with a road around a corner, and mud
    world.floor(-12, 12, -12, 12, PaintedWorld::Grass);
    world.floor(-10, -6, -12, 10, PaintedWorld::Road);
    world.floor(-10, 12, 6, 10, PaintedWorld::Road);
    world.floor(-3, 3, -6, 3, PaintedWorld::Mud);
    saveTree(world.map(), path("map.semantic"));
    folder.write("order.yaml", "best_to_worst: [road, grass, mud, unknown]\n");
  }

  std::string path(const std::string& name) const { return (folder / name).string(); }

  ProgramRun study(const std::vector<std::string>& more, const std::string& output = "out",
                   const std::string& reference = "200") const {
    std::vector<std::string> arguments = {path("map.semantic"), "-f"};
    const std::map<std::string, std::string> common = {
        {"--classes", path("order.yaml")}, {"--output", path(output)}, {"--instances", "4"},
        {"--min-distance", "8"},           {"--budgets", "60,120"},    {"--reference", reference}};
    for (const auto& [name, value] : common) arguments.insert(arguments.end(), {name, value});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram("planning-study", arguments);
  }

  std::vector<Row> rows(const std::string& output = "out") const {
    const auto table = csvTable(folder.read(output + "/study.csv"));
    std::vector<Row> result;
    for (std::size_t r = 1; r < table.size(); ++r) {
      Row row;
      for (std::size_t i = 0; i < table[0].size(); ++i) row[table[0][i]] = table[r].at(i);
      result.push_back(row);
    }
    return result;
  }

  /** All but the times. */
  std::vector<Row> outcomes(const std::string& output) const {
    auto result = rows(output);
    for (Row& row : result)
      for (const char* time : {"graph [ms]", "evaluation [ms]", "search [ms]", "first path [ms]"})
        row.erase(time);
    return result;
  }

  void expectRefused(const ProgramRun& run, const std::string& part) const {
    EXPECT_NE(run.status, 0);
    EXPECT_TRUE(contains(run.errors, part)) << run.errors;
    EXPECT_FALSE(std::filesystem::exists(folder / "out/study.csv"));
  }

  TemporaryFolder folder;
};

}  // namespace

TEST_F(PlanningStudy, allWaysToPlanGetTheSameTasks) {
  ASSERT_EQ(study({}).status, 0);
  std::map<std::string, std::set<std::string>> tasksOfWay;
  for (const Row& row : rows()) {
    std::string task;
    for (const char* part :
         {"instance", "start x", "start y", "start heading", "goal x", "goal y", "goal heading"})
      task += row.at(part) + " ";
    EXPECT_TRUE(tasksOfWay[wayOf(row)].insert(task).second) << "twice: " << wayOf(row);
  }
  constexpr std::size_t kGraphs = 5, kJudgments = 4, kKept = 1, kBudgets = 2, kReference = 1;
  ASSERT_EQ(tasksOfWay.size(), kGraphs * (kJudgments + kKept) * kBudgets + kReference);
  for (const auto& [way, tasks] : tasksOfWay) EXPECT_EQ(tasks, tasksOfWay.begin()->second) << way;
}

/** As in the paper: one vertex a leaf, with its class; costs count edges. */
TEST_F(PlanningStudy, costsMayCountEdgesInGraphsOfAFileOfWeights) {
  folder.write("weights.yaml", "relevant: {road: 1}\nalpha: 0.001\nname: roads\n");
  const std::string weights = (folder / "weights.yaml").string();
  expectRefused(study({"--graphs", "leaves", "--weights", weights, "--solution", "none"}),
                weights + ": unknown solution 'none'");
  ASSERT_EQ(
      study({"--graphs", "leaves", "--weights", weights, "--solution", "roads", "--cost", "count"})
          .status,
      0);
  int found = 0;
  for (const Row& row : rows()) {
    if (row.at("found") != "1" || row.at("judgment") != "endpoint") continue;
    std::vector<long long> cost = numbers(row.at("cost [0.1 mm]"));
    cost.pop_back();  // the length
    for (const long long edges : cost) EXPECT_LT(edges, 1000) << "numbers of edges";
    ++found;
  }
  EXPECT_GT(found, 0);
}

TEST_F(PlanningStudy, equalSeedsGiveEqualResultsApartFromTimes) {
  ASSERT_EQ(study({"--seed", "5", "--graphs", "compressed,halton"}, "first").status, 0);
  ASSERT_EQ(study({"--seed", "5", "--graphs", "compressed,halton"}, "second").status, 0);
  ASSERT_EQ(study({"--seed", "6", "--graphs", "compressed,halton"}, "other").status, 0);
  EXPECT_EQ(outcomes("first"), outcomes("second"));
  EXPECT_NE(outcomes("first"), outcomes("other"));
}

TEST_F(PlanningStudy, graphsKeepTheirBudgetsAndPathsAreNoShorterThanTheLine) {
  ASSERT_EQ(study({}).status, 0);
  constexpr int kQueryVertices = 2, kQueryEdges = 2 * 20 + 1;
  for (const Row& row : rows()) {
    const int budget = std::stoi(row.at("budget"));
    EXPECT_LE(std::stoi(row.at("vertices")), budget + kQueryVertices);
    if (row.at("graph") != "reference") {
      EXPECT_LE(std::stoi(row.at("edges")), 5 * budget + kQueryEdges);
    }
    if (row.at("found") == "0") continue;
    const double line = std::hypot(std::stod(row.at("goal x")) - std::stod(row.at("start x")),
                                   std::stod(row.at("goal y")) - std::stod(row.at("start y")));
    EXPECT_GE(line, 8 - 1e-3);
    EXPECT_GE(colored_graph::toMeters(numbers(row.at("way [0.1 mm]")).back()), line - 1e-3);
  }
}

TEST_F(PlanningStudy, noJudgmentFindsABetterWayInAGraphThanTheProfile) {
  ASSERT_EQ(study({}).status, 0);
  const auto all = rows();
  std::map<std::string, std::vector<long long>> best;  // of a graph and a task
  const auto keyOf = [](const Row& row) {
    return row.at("graph") + " " + row.at("budget") + " " + row.at("instance");
  };
  for (const Row& row : all)
    if (row.at("judgment") == "profile" && row.at("found") == "1")
      best[keyOf(row)] = numbers(row.at("way [0.1 mm]"));
  ASSERT_FALSE(best.empty());
  for (const Row& row : all) {
    EXPECT_EQ(row.at("found") == "1", best.count(keyOf(row)) == 1);
    if (row.at("found") == "1") {
      EXPECT_GE(numbers(row.at("way [0.1 mm]")), best[keyOf(row)]) << wayOf(row);
    }
  }
}

TEST_F(PlanningStudy, theSummaryIsThatOfTheTable) {
  ASSERT_EQ(study({"--graphs", "halton_drivable,full"}).status, 0);
  std::map<std::string, std::vector<double>> planning;
  for (const Row& row : rows())
    if (row.at("found") == "1")
      planning[wayOf(row)].push_back(std::stod(row.at("evaluation [ms]")) +
                                     std::stod(row.at("search [ms]")));
  const json map = json::parse(folder.read("out/study.json")).at("maps").at(0);
  EXPECT_EQ(map.at("ways").size(), 5u * 2 * 2 + 1);
  for (const json& way : map.at("ways")) {
    const auto& sample = planning[wayOf({{"judgment", way.at("judgment")},
                                         {"graph", way.at("graph")},
                                         {"budget", way.at("budget").dump()},
                                         {"memory", way.at("memory")}})];
    ASSERT_EQ(way.at("found"), sample.size());
    if (sample.empty()) continue;
    const double sum = std::accumulate(sample.begin(), sample.end(), 0.0);
    EXPECT_NEAR(way.at("milliseconds").at("planning").at("mean").get<double>(),
                sum / static_cast<double>(sample.size()), 1e-3 * sum);
  }
  for (const json& pair : map.at("pairs")) {
    const json& order = pair.at("way");
    EXPECT_EQ(
        order.at("better").get<int>() + order.at("equal").get<int>() + order.at("worse").get<int>(),
        4);
  }
}

TEST_F(PlanningStudy, peersPlanTheFirstTasksAndFiguresAreDrawn) {
  const ProgramRun run = study(
      {"--graphs", "halton_drivable", "--peers", "--peer-time", "0.1,0.3", "--peer-instances", "1"},
      "out", "0");
  ASSERT_EQ(run.status, 0) << run.errors;
  std::multiset<std::string> peers;
  for (const Row& row : rows())
    if (row.at("graph").back() == '*')
      peers.insert(row.at("graph") + row.at("instance") + " " + row.at("budget"));
  EXPECT_EQ(peers, (std::multiset<std::string>{"bit*0 100", "bit*0 300", "lazy-prm*0 100",
                                               "lazy-prm*0 300", "prm*0 100", "prm*0 300"}));
  for (const char* name : {"study.md", "times.png", "paths.png"})
    EXPECT_GT(std::filesystem::file_size(folder / (std::string("out/") + name)), 500u) << name;
}

TEST_F(PlanningStudy, rememberedEdgesChangeNoPath) {
  ASSERT_EQ(study({}).status, 0);
  std::map<std::string, std::map<std::string, std::string>> ways;  // of a graph and a task
  for (const Row& row : rows())
    if (row.at("judgment") == "profile" && row.at("graph") != "reference")
      ways[row.at("graph") + " " + row.at("budget") + " " + row.at("instance")][row.at("memory")] =
          row.at("way [0.1 mm]");
  EXPECT_EQ(ways.size(), 5u * 2 * 4);
  for (const auto& [task, way] : ways) EXPECT_EQ(way.at("kept"), way.at("cold")) << task;
}

TEST_F(PlanningStudy, studiesOfSeveralMapsAreJoined) {
  const std::vector<std::string> few = {"--graphs", "halton"};
  const auto joined = [&](const std::string& second) {
    return runProgram("planning-study",
                      {"--join", path("first"), path(second), "--output", path("out")});
  };
  ASSERT_EQ(study(few, "first").status, 0);
  ASSERT_EQ(study({"--graphs", "full"}, "strange").status, 0);
  expectRefused(joined("strange"), "other options");
  expectRefused(joined("nothing"), "nothing");
  ASSERT_EQ(study(few, "second").status, 0);
  const ProgramRun run = joined("second");
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(rows().size(), rows("first").size() + rows("second").size());
  EXPECT_EQ(json::parse(folder.read("out/study.json")).at("maps").size(), 2u);
}

TEST_F(PlanningStudy, badInputIsRefusedAndNothingWritten) {
  folder.write("strange.yaml", "best_to_worst: [road, lava]\n");
  expectRefused(runProgram("planning-study", {path("no.semantic"), "--classes", path("order.yaml"),
                                              "--output", path("out")}),
                "no.semantic");
  expectRefused(runProgram("planning-study", {path("map.semantic"), "--classes",
                                              path("strange.yaml"), "--output", path("out")}),
                "lava");
  expectRefused(study({"--graphs", "spiral"}), "spiral");
  expectRefused(study({"--edges-per-vertex", "-1"}), "edges-per-vertex");
  expectRefused(study({path("map.semantic")}), "a second map");
}

TEST_F(PlanningStudy, tasksThatAMapDoesNotOfferAreRefused) {
  ProgramRun run =
      runProgram("planning-study", {path("map.semantic"), "--classes", path("order.yaml"),
                                    "--output", path("out"), "--min-distance", "500"});
  expectRefused(run, "500");
}
