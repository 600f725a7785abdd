#pragma once
#include <gtest/gtest.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/TreeFile.h>

#include <nlohmann/json.hpp>

#include "../semantic_octree/SmallScans.h"
#include "RunProgram.h"
#include "TemporaryFolder.h"

constexpr int K = 6;
inline const char* const kNames[K] = {"post", "road", "grass", "wall, low", "tree", "car"};

inline semantic_types::ClassTable namedClasses() {
  semantic_types::ClassTable table;
  for (const char* name : kNames)
    table.add(name, {static_cast<std::uint8_t>(40 * table.size()), 90, 120});
  return table;
}

inline semantic_octree::SemanticOcTree smallMap(const semantic_types::ClassTable& table,
                                                int classes = K) {
  semantic_octree::SemanticOcTree map(0.2, table);
  for (const PosedCloud& scan : scansOfSmallPlace(3, 3000, classes, 7))
    map.insert(scan.cloud, scan.T_map_sensor);
  return map;
}

inline const char* const kTwoSolutions = R"(
block_size: 3.2
solutions:
  - {name: posts, relevant: {post: 1}, irrelevant: {grass: 0.2}, alpha: 0.01}
  - name: ground_and-cars
    relevant:
      ground: {classes: [road, grass], weight: 1}
      car: 0.5
    everything: 0.1
    alpha: 0.02
)";

/** A small map, and the program on it. */
class SemanticMapCompress : public FolderTest {
 protected:
  void SetUp() override { saveTree(smallMap(namedClasses()), mapFile()); }

  std::string mapFile() const { return path("map.semantic"); }
  std::filesystem::path output() const { return folder / "out"; }

  ProgramRun compress(const std::string& weights, Words more = {}) const {
    const std::filesystem::path file = folder.write("weights.yaml", weights);
    return runProgram(
        "semantic-map-compress",
        joined({mapFile(), "--weights", file.string(), "--output", output().string(), "-f"}, more));
  }
  nlohmann::json reportOf(const std::string& weights, const Words& more = {}) const {
    succeeded(compress(weights, more));
    return nlohmann::json::parse(folder.read("out/report.json"));
  }
  void expectRefusal(const ProgramRun& run, const Words& parts) const {
    EXPECT_NE(run.status, 0);
    for (const std::string& part : parts) EXPECT_TRUE(contains(run.errors, part));
    EXPECT_FALSE(std::filesystem::exists(output()));
  }
  void expectRefusalOf(const std::string& solution, const Words& parts) const {
    expectRefusal(compress(solution), parts);
  }
};
