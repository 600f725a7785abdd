#pragma once
#include <map_correction/KeyframeMap.h>
#include <semantic_abstraction/Abstraction.h>

#include <algorithm>
#include <vector>

#include "RandomScans.h"

/** Maps of keyframes, and what they have to hold. */
namespace keyframe_scans {

using namespace semantic_octree;

/** How a map of keyframes is made. */
struct Variant {
  const char* name;
  bool softLabels = false, pruning = true;
  int threads = 1;
  AbstractionOptions::Frame frame = AbstractionOptions::Frame::Free;
  InsertionOptions::Rays rays = InsertionOptions::Rays::All;
  bool ages = false;
  double alpha = 0.01;
  double blockSize = AbstractionOptions().blockSize;
};

inline AbstractionOptions abstractionOf(const Variant& variant) {
  AbstractionOptions options;
  options.weights = {
      {tree_abstraction::relevant("1", 1, {1}), tree_abstraction::irrelevant("2", 0.5, {2})},
      variant.alpha};
  options.blockSize = variant.blockSize;
  options.frame = variant.frame;
  return options;
}

inline SemanticOcTree emptyMap(const Variant& variant, const FilterParameters& filter = {}) {
  semantic_types::ClassTable classes = numberedClasses(5);
  for (const semantic_types::ClassId id : {0, 1, 2, 3})
    if (variant.ages) classes.setHalfLife(id, 0.7 + 0.4 * id);
  SemanticOcTree map(0.4, classes, filter);
  map.setPruning(variant.pruning);
  setAbstraction(map, abstractionOf(variant));
  return map;
}

inline InsertionOptions optionsOf(const Variant& variant) {
  InsertionOptions options;
  options.threads = variant.threads;
  options.rays = variant.rays;
  options.maxRange = 6;
  return options;
}

/** Scans that were inserted, in their order: the oracle. */
class Scans {
 public:
  struct Entry {
    KeyframeId keyframe;
    PosedCloud scan;        ///< its pose is that in the keyframe
    std::int64_t time = 0;  ///< ms
  };
  std::vector<Eigen::Isometry3d> poses;
  std::vector<Entry> all;
  std::int64_t now = 0;  ///< ms

  SemanticOcTree mappedFromScratch(const Variant& variant,
                                   const FilterParameters& filter = {}) const {
    SemanticOcTree map = emptyMap(variant, filter);
    std::int64_t time = 0;
    for (const Entry& e : all) {
      map.insert(e.scan.cloud, poses[e.keyframe] * e.scan.T_map_sensor, optionsOf(variant),
                 1e-3 * static_cast<double>(e.time - time));
      time = e.time;
    }
    map.age(1e-3 * static_cast<double>(now - time));
    return map;
  }
  void removeOf(KeyframeId keyframe) {
    all.erase(std::remove_if(all.begin(), all.end(),
                             [keyframe](const Entry& e) { return e.keyframe == keyframe; }),
              all.end());
  }
};

}  // namespace keyframe_scans
