#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "RunProgram.h"
#include "TemporaryFolder.h"

namespace {

template <typename T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

/** A scene file: a ring of points around a sensor that moves on. */
std::string sceneFile(int numScans) {
  std::string bytes;
  append(bytes, static_cast<std::uint32_t>(numScans));
  for (int scan = 0; scan < numScans; ++scan) {
    for (int i = 0; i < 16; ++i) append(bytes, i == 3 ? 0.5 * scan : double(i % 5 == 0));
    append(bytes, std::uint32_t(360));
    for (int i = 0; i < 360; ++i) {
      append(bytes, static_cast<float>(5 * std::cos(i * M_PI / 180)));
      append(bytes, static_cast<float>(5 * std::sin(i * M_PI / 180)));
      append(bytes, 0.1f);
      append(bytes, static_cast<std::uint16_t>(1 + i % 6));
    }
  }
  return bytes;
}

ProgramRun benchmark(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--repeats", "2"});
  return runProgram("insertion-benchmark", arguments);
}

}  // namespace

TEST(InsertionBenchmark, measuresEveryRunnerInOneRun) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ring.bin", sceneFile(4)).string();
  const ProgramRun run = benchmark({scene, "--scans", "3", "--json"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const auto json = nlohmann::json::parse(run.output);
  EXPECT_EQ(json["scans"], 3);
  EXPECT_EQ(json["points"], 3 * 360);
  EXPECT_GT(json["touchedVoxels"], 1000);
  EXPECT_LT(json["touchedVoxels"], 10000);
  ASSERT_EQ(json["contestants"].size(), 7u);
  for (const auto& runner : json["contestants"]) {
    EXPECT_GT(runner["cpuMilliseconds"], 0) << runner;
    EXPECT_GT(runner["wallMilliseconds"], 0) << runner;
    EXPECT_EQ(runner["cpuMillisecondsOfRepeats"].size(), 2u);
    EXPECT_EQ(runner["name"] == json["ratioTo"], runner["ratio"] == 1.0) << runner;
  }
}

TEST(InsertionBenchmark, printsATableOfTheChosenRunners) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("ring.bin", sceneFile(2)).string();
  const ProgramRun run =
      benchmark({scene, "--only", "ColorOcTree", "--rays", "endpoints", "--threads", "2"});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_TRUE(contains(run.output, "bare traversal"));
  EXPECT_TRUE(contains(run.output, "octomap::ColorOcTree"));
  EXPECT_FALSE(contains(run.output, "mrpt"));
  EXPECT_TRUE(contains(run.output, "rays endpoints, 2 thread(s)"));
}

TEST(InsertionBenchmark, refusesWhatIsNoScene) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& content) {
    const ProgramRun run = benchmark({folder.write("bad.bin", content).string()});
    EXPECT_NE(run.status, 0);
    return run.errors;
  };
  const std::string good = sceneFile(2);
  EXPECT_TRUE(contains(error(""), "truncated"));
  EXPECT_TRUE(contains(error(good.substr(0, good.size() - 1)), "truncated"));
  std::string bad = good;
  bad[4 + 7] = '\x7f';
  EXPECT_TRUE(contains(error(bad), "pose"));
  bad = good;
  bad[4 + 128 + 4 + 13] = 1;
  EXPECT_TRUE(contains(error(bad), "label 257"));
  EXPECT_TRUE(contains(error(std::string(4, '\0')), "no scans"));
  EXPECT_TRUE(contains(benchmark({"missing.bin"}).errors, "missing.bin"));
  EXPECT_NE(benchmark({}).status, 0);
  EXPECT_NE(benchmark({"--rawlog", "x.rawlog"}).status, 0);
}
