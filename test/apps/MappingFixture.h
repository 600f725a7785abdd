#pragma once
#include <gtest/gtest.h>
#include <semantic_octree/TreeFile.h>

#include <nlohmann/json.hpp>

#include "RunProgram.h"
#include "SmallRawlogs.h"
#include "TemporaryFolder.h"

inline const char* const kSmallConfig =
    "[map]\n"
    "resolution = 0.5\n"
    "classes = classes.yaml\n"
    "[pictures]\n"
    "width = 300\n"
    "height = 200\n";

/** A folder with a configuration, a class table and a rawlog of one scan. From (1, 0, 0) it sees
 * road at (2, 0, 0) and a car at (0, 3, 0). */
class Rawlog2SemanticMap : public FolderTest {
 protected:
  void SetUp() override {
    folder.write("small.ini", kSmallConfig);
    folder.write("classes.yaml", kSmallTable);
    writeSmallRawlog(folder / "small.rawlog", robotPose(10, 1.1), smallScan(10));
  }

  static labeled_cloud::CObservationLabeledCloud smallScan(double seconds) {
    return labeledCloud(seconds, {{1.1f, 0.2f, 0.2f}, {-1, 3, 0.2f}}, {1, 3});
  }

  ProgramRun run(const std::string& rawlog = "small.rawlog", const Words& more = {}) const {
    Words arguments = joined({"--config", path("small.ini"), "--output", path("out"), "-f"}, more);
    arguments.push_back(path(rawlog));
    return runProgram("rawlog2semantic-map", arguments);
  }

  semantic_octree::SemanticOcTree map() const {
    return semantic_octree::loadTree(path("out/map.semantic"));
  }
  nlohmann::json summary() const { return nlohmann::json::parse(folder.read("out/summary.json")); }

  /** Runs it where results are already; it must fail with one line that holds all of these, and
   * leave the results as they were. */
  void expectRefusal(const Words& parts, const std::string& rawlog = "small.rawlog",
                     const Words& more = {}) const {
    for (const char* name : {"map.semantic", "summary.json", "top.png", "view.png"})
      folder.write(std::string("out/") + name, "of before");
    ::expectRefusal(run(rawlog, more), joined({"rawlog2semantic-map: "}, parts));
    for (const char* name : {"map.semantic", "summary.json", "top.png", "view.png"})
      EXPECT_EQ(folder.read(std::string("out/") + name), "of before");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "out"), {}), 4);
  }
};
