#pragma once
#include <labeled_cloud/ScanStream.h>
#include <semantic_octree/InsertionOptions.h>
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_slam/Slam.h>

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace rawlog2semantic_map {

/** The abstraction along the way; one entry a scan. */
struct AbstractionSummary {
  std::vector<std::size_t> leaves, compressedLeaves;
  /** Telling what changed in the optimal tree; inserting without upkeep, if that was tried: ms. */
  std::vector<double> changeTimes, insertionTimesWithout;
};

/** What became of the observations on their way into the map. */
struct Summary {
  std::vector<std::string> rawlogs;
  std::size_t read = 0, inserted = 0;
  /** Pictures that were there to label scans, and observations that the trajectory is made of. */
  std::size_t pictures = 0, poses = 0;
  /** Whether the trajectory is from the rawlogs. */
  bool posesAreUsed = false;
  /** Whether the end of the rawlogs was not reached: somebody asked to stop. */
  bool stopped = false;
  /** What was wrong with observations that were left out: how often, and the first of them. */
  std::size_t numProblems = 0;
  std::vector<std::string> problems;
  /** Number of observations that were not inserted, by the reason. */
  std::map<std::string, std::size_t> skipped;
  /** Scans for which labels were looked for and not found. */
  std::size_t withoutLabels = 0;
  /** Sums over the scans that were inserted. */
  labeled_cloud::ScanCounts conversion;
  semantic_octree::InsertionReport insertion;
  /** How far the labels of each scan that has any were trusted. */
  std::vector<semantic_octree::LabelReliability> labels;
  /** Milliseconds of each inserted scan: making the cloud, inserting it. */
  std::vector<double> conversionTimes, insertionTimes;
  /** Where an abstraction is kept, after each inserted scan. */
  AbstractionSummary abstraction;
  std::optional<semantic_slam::SlamReport> slam;  ///< if poses were corrected

  void add(const labeled_cloud::ScanCounts& counts);
  void addProblems(const std::vector<std::string>& more);
  void add(const semantic_octree::InsertionReport& report);
  /** Counts it. \return what became of it, in words */
  std::string note(const labeled_cloud::StreamedObservation& observation);
  std::size_t numSkipped() const;
  /** The medians of all scans with labels; nothing if there are none. */
  std::optional<semantic_octree::LabelReliability> labelReliability() const;
  /** What share of the points has a label, with a warning below a half. */
  std::string labeledText() const;
  /** "3 skipped (2 outside the trajectory, 1 CObservationImage)" */
  std::string skippedText() const;
};

/** The summary with what the map holds, for summary.json. \param countVoxels goes through all of
 * the map */
nlohmann::ordered_json toJson(const Summary& summary, const semantic_octree::SemanticOcTree& tree,
                              bool countVoxels);

}  // namespace rawlog2semantic_map
