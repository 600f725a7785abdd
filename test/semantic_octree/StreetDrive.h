#pragma once
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/SemanticOcTree.h>

#include "RandomScans.h"

/** What benchmarks insert: a drive through a street, 64 x 1024 beams every meter. */
namespace street_drive {

using namespace semantic_octree;

constexpr int kScans = 200;

inline const std::vector<PosedCloud>& scans() {
  static const std::vector<PosedCloud> scans = [] {
    std::mt19937 random(1);
    std::vector<PosedCloud> made;
    for (int i = 0; i < kScans; ++i)
      made.push_back(streetScan(random, {double(i), 0, 0}, 64, 1024));
    return made;
  }();
  return scans;
}

inline InsertionOptions insertion() {
  InsertionOptions options;
  options.maxRange = 25;
  return options;
}

inline void insertAll(SemanticOcTree& map) {
  for (const PosedCloud& scan : scans()) map.insert(scan.cloud, scan.T_map_sensor, insertion());
}

inline SemanticOcTree emptyMap(bool withAbstraction = false,
                               const semantic_types::ClassTable& classes = numberedClasses(24)) {
  SemanticOcTree map(0.2, classes);
  if (!withAbstraction) return map;
  AbstractionOptions options;
  for (int i = 1; i <= 4; ++i)
    options.weights = {{tree_abstraction::relevant(std::to_string(i), 1, {i})}, 0.02};
  setAbstraction(map, options);
  return map;
}

}  // namespace street_drive
