#pragma once
#include <semantic_octree/AbstractionOptions.h>
#include <semantic_types/ClassTable.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace semantic_map_compress {

/** Name of class 0 in files and reports. */
constexpr const char* kFreeSpace = "free_space";

/** One way to weigh the classes, and the compressed map it leads to. */
struct Solution {
  std::string name;  ///< letters, digits, '-' and '_': files are named after it
  /** Weights > 0 are relevant, < 0 irrelevant. */
  std::vector<tree_abstraction::InformationTerm> terms;
  std::optional<double> alpha;
};

/** What the file of weights holds. */
struct WeightsFile {
  std::vector<Solution> solutions;
  /** All but the weights; the same for all solutions, so that they can be compared. */
  semantic_octree::AbstractionOptions space;
};

/** Reads one solution or a list `solutions`; the syntax stands in README.md.
 * \throw std::runtime_error naming file, line, key and value: unreadable, unknown or repeated key,
 * a class that is not in the table, a weight or alpha that is not a number >= 0, a class both
 * relevant and irrelevant, a solution without weights, two solutions of one name. */
WeightsFile loadWeights(const std::filesystem::path& file,
                        const semantic_types::ClassTable& classes);

}  // namespace semantic_map_compress
