#pragma once
#include <gtest/gtest.h>
#include <semantic_octree/TreeFile.h>

#include <algorithm>
#include <string>
#include <vector>

#include "../semantic_octree/SmallScans.h"
#include "RunProgram.h"
#include "TemporaryFolder.h"

/** Three classes with colors, the last with a name that must be quoted. */
inline semantic_types::ClassTable coloredClasses() {
  semantic_types::ClassTable table;
  table.add("post", {200, 30, 10});
  table.add("road", {20, 40, 220});
  table.add("grass, \"wet\"", {10, 190, 40});
  return table;
}

/** The small place's map: ground at 0 with posts on it, voxels of 0.2 m. */
inline semantic_octree::SemanticOcTree smallPlace(int firstScan = 0, int numScans = 4) {
  semantic_octree::SemanticOcTree map(0.2, coloredClasses());
  const auto scans = scansOfSmallPlace(firstScan + numScans, 4000, 3, 11);
  for (int i = firstScan; i < firstScan + numScans; ++i)
    map.insert(scans[i].cloud, scans[i].T_map_sensor);
  return map;
}

/** It failed with one line that holds all of these. */
inline void expectRefusal(const ProgramRun& run, const std::vector<std::string>& parts) {
  EXPECT_EQ(run.status, 1) << run.errors;
  EXPECT_EQ(std::count(run.errors.begin(), run.errors.end(), '\n'), 1) << run.errors;
  for (const std::string& part : parts)
    EXPECT_TRUE(contains(run.errors, part)) << part << " is not in: " << run.errors;
}

/** A map in a folder of its own, and programs that take it. */
class MapTool : public testing::Test {
 protected:
  void SetUp() override { saveTree(map, path("map.semantic")); }

  std::string path(const std::string& name) const { return (folder / name).string(); }

  /** Writes the map into these files of the folder. */
  ProgramRun exportTo(const std::vector<std::string>& names,
                      const std::vector<std::string>& options = {},
                      const std::string& from = "map.semantic") const {
    std::vector<std::string> arguments = {path(from)};
    for (const std::string& name : names) arguments.insert(arguments.end(), {"-o", path(name)});
    arguments.insert(arguments.end(), options.begin(), options.end());
    return runProgram("semantic-map-export", arguments);
  }

  const semantic_octree::SemanticOcTree map = smallPlace();
  TemporaryFolder folder;
};
