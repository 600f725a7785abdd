#pragma once
#include <string>
#include <utility>
#include <vector>

#include "Compressor.h"
#include "measuring/Stopwatch.h"

namespace semantic_map_compress {

/** Milliseconds of each stage, in order. */
class StageTimer {
 public:
  /** Ends a stage that began when the one before it ended. */
  void add(const std::string& stage) { m_stages.emplace_back(stage, m_watch.lap()); }
  const std::vector<std::pair<std::string, double>>& stages() const { return m_stages; }

 private:
  measuring::Stopwatch m_watch;
  std::vector<std::pair<std::string, double>> m_stages;
};

/** The map to be compressed. */
struct FullMap {
  std::string file;
  double resolution = 0;  ///< m
  std::size_t nodes = 0, bytes = 0;
  /** K + 1 numbers of occupied voxels by their likeliest class; [0]: no class. */
  std::vector<std::uint64_t> voxelsOfClass;
};

/** What came of a solution. */
struct Compression {
  Solution solution;
  double alpha = 0;
  semantic_octree::AbstractionMeasures measures;
  /** What is kept of each term of the catalog. */
  std::vector<KeptInformation> kept;
  std::vector<CurvePoint> curve;
  CurvePoint chosen;
  std::size_t bytes = 0;  ///< of the compressed map's file
  StageTimer times;

  double leafRatio() const { return ratio(&tree_abstraction::TreeMeasures::numKnownLeaves); }
  double allLeafRatio() const { return ratio(&tree_abstraction::TreeMeasures::numLeaves); }

 private:
  double ratio(std::size_t tree_abstraction::TreeMeasures::*count) const {
    return static_cast<double>(measures.compressed.*count) /
           static_cast<double>(measures.full.*count);
  }
};

}  // namespace semantic_map_compress
