#pragma once
#include <colored_graph/ClassOrder.h>
#include <semantic_planning/planner/SemanticPlanner.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "Trial.h"

namespace planning_study {

struct StudyOptions {
  std::size_t instances = 50;
  std::uint64_t seed = 1;
  double minDistance = 30;  ///< from start to goal, meters
  std::vector<std::size_t> budgets = {250, 500, 1000, 2000};
  std::vector<semantic_planning::GraphKind> graphs;
  /** What the compressed tree keeps (semantic_planning::abstractionOf); none: what tells ranks
   * apart.
   */
  std::filesystem::path weights;
  std::string solution;
  /** Every graph may have this many edges for each vertex of its budget. */
  double edgesPerVertex = 5;
  /** Vertices of the dense graph that costs are compared with; 0: none. */
  std::size_t reference = 5000;
  bool peers = false;
  std::vector<double> peerTimes = {0.5};  ///< of each, processor seconds
  std::size_t peerInstances = 50;         ///< the first ones, for peers

  double minutes = std::numeric_limits<double>::infinity();  ///< no new instance after these

  /** Vehicle, ground, neighbors...; kind and budgets are the study's. */
  semantic_planning::PlannerOptions planner;

  /** \throw std::invalid_argument naming the field and its value. */
  void validate() const;
};

/** The options of all planners; what tells them apart is the study's.
 * \param planner must outlive the list. */
strict_files::OptionList sharedOptions(semantic_planning::PlannerOptions& planner);

extern const char* const kReference;  ///< Trial::graph of the dense graph

/** What was studied on a map. */
struct MapStudy {
  std::string name, file;
  double abstractionTime = 0, groundTime = 0;  ///< once for the map; processor milliseconds
  std::size_t instances = 0, compressedLeaves = 0, leaves = 0;
  int ranks = 0;
  std::vector<Trial> trials;
};

/** Studies one map, instance by instance. */
class StudyRunner {
 public:
  /** Loads the map, draws the instances, and prepares all planners.
   * \param options must outlive this. \throw std::runtime_error naming a file. */
  StudyRunner(const std::string& name, const std::string& file, const std::string& classesFile,
              const StudyOptions& options);
  ~StudyRunner();
  StudyRunner(StudyRunner&&) noexcept;

  void runNextInstance();
  const MapStudy& study() const;

 private:
  class Contest;
  std::unique_ptr<Contest> m_contest;
};

}  // namespace planning_study
