#pragma once
#include <gtest/gtest.h>
#include <semantic_octree/TreeFile.h>

#include <string>

#include "../semantic_octree/SmallScans.h"
#include "Classes.h"
#include "RunProgram.h"
#include "TemporaryFolder.h"

/** Three classes with colors, the last with a name that must be quoted. */
inline semantic_types::ClassTable coloredClasses() {
  return tableOf(
      {{"post", {200, 30, 10}}, {"road", {20, 40, 220}}, {"grass, \"wet\"", {10, 190, 40}}});
}

/** The small place's map: ground at 0 with posts on it, voxels of 0.2 m. */
inline semantic_octree::SemanticOcTree smallPlace(int firstScan = 0, int numScans = 4) {
  semantic_octree::SemanticOcTree map(0.2, coloredClasses());
  const auto scans = scansOfSmallPlace(firstScan + numScans, 4000, 3, 11);
  for (int i = firstScan; i < firstScan + numScans; ++i)
    map.insert(scans[i].cloud, scans[i].T_map_sensor);
  return map;
}

/** A map in a folder of its own, and programs that take it. */
class MapTool : public FolderTest {
 protected:
  void SetUp() override { saveTree(map, path("map.semantic")); }

  /** Writes the map into these files of the folder. */
  ProgramRun exportTo(const Words& names, const Words& options = {},
                      const std::string& from = "map.semantic") const {
    Words arguments = {path(from)};
    for (const std::string& name : names) arguments.insert(arguments.end(), {"-o", path(name)});
    return runProgram("semantic-map-export", joined(arguments, options));
  }

  const semantic_octree::SemanticOcTree map = smallPlace();
};
