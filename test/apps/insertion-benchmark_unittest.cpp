#include <gtest/gtest.h>

#include <string>

#include "RunProgram.h"
#include "TemporaryFolder.h"

namespace {

/** Two scans of the shipped sample. */
ProgramRun benchmark(Words arguments) {
  const std::string sources = MSO_SOURCE_DIR;
  arguments.insert(arguments.end(), {sources + "/rawlog-samples/village.rawlog", "--classes",
                                     sources + "/config/classes/synthetic.yaml", "--resolution",
                                     "0.5", "--scans", "2", "--repeats", "2"});
  return runProgram("insertion-benchmark", arguments);
}

}  // namespace

TEST(InsertionBenchmark, measuresEveryRunnerInOneRun) {
  const ProgramRun run = succeeded(benchmark({}));
  EXPECT_TRUE(contains(run.output, "2 scans"));
  for (const char* name :
       {"bare traversal of all rays", "semantic_octree with G", "octomap::OcTree, discretized",
        "octomap::ColorOcTree", "mrpt::maps::COctoMap"}) {
    const std::size_t row = run.output.find(name);
    ASSERT_NE(row, std::string::npos) << name;
    EXPECT_GT(std::stod(run.output.substr(row + 30)), 0) << name;
  }
}

TEST(InsertionBenchmark, measuresTheChosenRunners) {
  const ProgramRun run =
      succeeded(benchmark({"--only", "ColorOcTree", "--rays", "endpoints", "--threads", "2"}));
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
