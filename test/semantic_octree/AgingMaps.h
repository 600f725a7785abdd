#pragma once
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/TreeFile.h>

#include <sstream>

#include "RandomScans.h"

/** Maps in which some classes fade. */
namespace aging_maps {

using namespace semantic_octree;
using semantic_types::kForever;

constexpr int kClasses = 5;

/** Seconds: free space, classes 1 to 5. Class 4 stays, class 5 goes slowly. */
constexpr double kHalfLives[kClasses + 1] = {8, 1, 2.5, 4, kForever, 3e7};

inline ClassTable classes(bool freeDecays = true) {
  ClassTable table = numberedClasses(kClasses);
  for (int id = freeDecays ? 0 : 1; id <= kClasses; ++id)
    table.setHalfLife(static_cast<ClassId>(id), kHalfLives[id]);
  return table;
}

inline AbstractionOptions abstraction(double alpha = 0.01) {
  AbstractionOptions options;
  options.weights.terms = {tree_abstraction::relevant("1", 1, {1}),
                           tree_abstraction::irrelevant("2", 0.5, {2})};
  options.weights.alpha = alpha;
  return options;
}

inline void insertRandom(SemanticOcTree& map, std::mt19937& random, double secondsSince = 0) {
  RandomScanOptions scans;
  scans.softLabels = random() % 4 == 0;
  const PosedCloud scan = randomScan(random, scans);
  InsertionOptions options;
  options.maxRange = 6;
  map.insert(scan.cloud, scan.T_map_sensor, options, secondsSince);
}

inline SemanticOcTree randomMap(unsigned seed, const ClassTable& table, bool pruning = true) {
  std::mt19937 random(seed);
  SemanticOcTree map(0.4, table);
  map.setPruning(pruning);
  for (int i = 0; i < 4; ++i) insertRandom(map, random, 0.7);
  return map;
}

inline std::string bytesOf(const SemanticOcTree& map) {
  std::ostringstream out;
  writeTree(out, map);
  return out.str();
}

inline SemanticOcTree reloaded(const SemanticOcTree& map) {
  std::istringstream in(bytesOf(map));
  return readTree(in);
}

}  // namespace aging_maps
