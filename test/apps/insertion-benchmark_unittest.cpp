#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "RunProgram.h"
#include "TemporaryFolder.h"

namespace {

/** Two scans of the shipped sample. */
ProgramRun benchmark(std::vector<std::string> arguments) {
  const std::string sources = MSO_SOURCE_DIR;
  arguments.insert(arguments.end(), {sources + "/rawlog-samples/village.rawlog", "--classes",
                                     sources + "/config/classes/synthetic.yaml", "--resolution",
                                     "0.5", "--scans", "2", "--repeats", "2"});
  return runProgram("insertion-benchmark", arguments);
}

}  // namespace

TEST(InsertionBenchmark, measuresEveryRunnerInOneRun) {
  const ProgramRun run = benchmark({"--json"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const auto json = nlohmann::json::parse(run.output);
  EXPECT_EQ(json["scans"], 2);
  EXPECT_GT(json["points"], 10000);
  EXPECT_GT(json["touchedVoxels"], 1000);
  ASSERT_EQ(json["contestants"].size(), 7u);
  for (const auto& runner : json["contestants"]) {
    EXPECT_GT(runner["cpuMilliseconds"], 0) << runner;
    EXPECT_GT(runner["wallMilliseconds"], 0) << runner;
    EXPECT_EQ(runner["cpuMillisecondsOfRepeats"].size(), 2u);
    EXPECT_EQ(runner["name"] == json["ratioTo"], runner["ratio"] == 1.0) << runner;
  }
}

TEST(InsertionBenchmark, printsATableOfTheChosenRunners) {
  const ProgramRun run =
      benchmark({"--only", "ColorOcTree", "--rays", "endpoints", "--threads", "2"});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_TRUE(contains(run.output, "bare traversal"));
  EXPECT_TRUE(contains(run.output, "octomap::ColorOcTree"));
  EXPECT_FALSE(contains(run.output, "mrpt"));
  EXPECT_TRUE(contains(run.output, "rays endpoints, 2 thread(s)"));
}

TEST(InsertionBenchmark, refusesWhatIsNoRawlog) {
  const ProgramRun run = runProgram("insertion-benchmark", {"missing", "--classes", "no.yaml"});
  EXPECT_TRUE(contains(run.errors, "no.yaml"));
  EXPECT_NE(runProgram("insertion-benchmark", {"missing"}).status, 0);
}
