#pragma once
#include <map_folders/MapFolder.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_abstraction/AbstractionOptions.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "measuring/Measuring.h"

namespace semantic_map_compress {

using semantic_octree::AbstractionOptions;
using semantic_octree::TermCatalog;

/** How small compressed maps are to be; at most one is set. None: each solution's own alpha. */
struct Target {
  std::optional<double> alpha;
  std::optional<std::size_t> leaves;  ///< known leaves
  std::optional<double> share;        ///< of the known leaves
  std::optional<std::size_t> bytes;   ///< of the file
};

/** What the full and a compressed tree tell about one term. Nats. */
struct KeptInformation {
  double full = 0, kept = 0;
  /** Share that is kept; none where there is none to keep. */
  std::optional<double> share;
};

/** The compressed trees of one map for different weights. */
class Compressor {
 public:
  /** The map keeps G-values from now on. \param ofAll what all solutions have in common
   * \param tiles of compressed maps, if the map may be larger than memory \param scratch a folder
   * for these, which comes and goes \throw std::invalid_argument the map is empty. */
  Compressor(semantic_octree::SemanticOcTree& map, const TermCatalog& catalog,
             AbstractionOptions ofAll, std::optional<semantic_octree::MapFolderOptions> tiles,
             std::filesystem::path scratch);

  /** The compressed tree is that of these weights from now on. */
  void weigh(const AbstractionOptions& solution, double alpha);
  /** Alpha of the largest compressed tree within the target. For bytes: the next larger one
   * does not fit. \throw std::runtime_error naming the solution: no alpha is given, or no tree is
   * that small, or more leaves are wanted than there are. */
  double alphaFor(const AbstractionOptions& solution, const Target& target);

  semantic_octree::Abstraction abstraction() { return semantic_octree::Abstraction(m_map); }
  /** The present tree as a map. The one before must be gone. */
  std::unique_ptr<semantic_octree::StoredMap> compressed();
  /** What the measures say about each term of the catalog. */
  std::vector<KeptInformation> kept(const semantic_octree::AbstractionMeasures& measures) const;

 private:
  double alphaForLeaves(const AbstractionOptions& solution, std::size_t wanted);
  double alphaForBytes(const AbstractionOptions& solution, std::size_t wanted);

  semantic_octree::SemanticOcTree& m_map;
  const TermCatalog& m_catalog;
  std::optional<semantic_octree::MapFolderOptions> m_tiles;
  std::filesystem::path m_scratch;
};

/** One of a solution's compressed trees. */
struct CurvePoint {
  double alpha = 0;
  std::size_t leaves = 0;  ///< known ones
  /** Share of the information of the relevant and of the irrelevant terms, by their weights. None:
   * there are no such terms. */
  std::optional<double> relevant, irrelevant;
};

/** The compressor's present tree as a point of the curve of its present weights. */
CurvePoint curvePoint(Compressor& compressor, const semantic_octree::AbstractionMeasures& measures);

/** Compressed trees of the compressor's present weights, from the blocks alone (first) to alpha = 0
 * (last), evenly spread over the logarithm of the number of leaves. */
std::vector<CurvePoint> alphaCurve(Compressor& compressor);

/** Milliseconds of each stage, in order. */
class StageTimer {
 public:
  /** Ends a stage that began when the one before it ended. */
  void add(const std::string& stage) { m_stages[stage] = m_watch.lap(); }
  const nlohmann::ordered_json& stages() const { return m_stages; }

 private:
  measuring::Stopwatch m_watch;
  nlohmann::ordered_json m_stages;
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
  AbstractionOptions solution;
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
