#pragma once
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_types/ClassTable.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace semantic_octree {

/** Name of class 0 in files and reports. */
constexpr const char* kFreeSpace = "free_space";

/** What an abstraction keeps, by the names of classes: one line an option, for .ini files. */
struct AbstractionText : AbstractionSpace {
  /** Classes worth keeping and worth dropping with their weights (beta, gamma), "road: 1, car:
   * 0.5". Several classes that count as one are joined by "+": "road+parking: 1". */
  std::string relevant, irrelevant;
  /** Weight of the whole class variable (which class it is, or free); negative: worth dropping. */
  double everything = 0;
  /** Price of a nat of I_X. */
  double alpha = tree_abstraction::kAlpha;
  /** What unknown space is, for `unknown = prior`: "free_space: 0.6, road: 0.2"; classes that are
   * not named share the rest evenly. */
  std::string prior;
  /** Regions of their own weight, m in the map's frame, separated by semicolons:
   * "box x0 y0 z0 x1 y1 z1 weight", "sphere x y z radius weight",
   * "corridor x0 y0 z0 x1 y1 z1 radius weight". */
  std::string regions;

  bool isSet() const { return !relevant.empty() || !irrelevant.empty() || everything != 0; }
  /** The same for a map of these classes.
   * \throw std::invalid_argument naming the option and its value. */
  AbstractionOptions forClasses(const semantic_types::ClassTable& classes) const;
  void describe(strict_files::OptionList& list);
  /** Checks all but what depends on the classes. \throw std::invalid_argument */
  void validate() const;
};

/** One way to weigh the classes, and the compressed map it leads to. */
struct Solution {
  std::string name;  ///< letters, digits, '-' and '_': files are named after it
  /** Weights > 0 are relevant, < 0 irrelevant. */
  std::vector<tree_abstraction::InformationTerm> terms;
  std::optional<double> alpha;
};

/** What a file of weights holds. */
struct WeightsFile {
  std::string name;  ///< what messages call it
  std::vector<Solution> solutions;
  /** All but the weights; the same for all solutions, so that they can be compared. */
  AbstractionOptions space;

  /** \param wanted a solution's name; empty: the first \throw std::runtime_error naming the file:
   * it has none of this name. */
  const Solution& solution(const std::string& wanted) const;
};

/** Reads one solution or a list `solutions` (YAML); the syntax stands in the README of
 * semantic-map-compress.
 * \throw std::runtime_error naming file, line, key and value: unreadable, unknown or repeated key,
 * a class that is not in the table, a weight or alpha that is not a number >= 0, a class both
 * relevant and irrelevant, a solution without weights, two solutions of one name. */
WeightsFile loadWeights(const std::filesystem::path& file,
                        const semantic_types::ClassTable& classes);
/** The same of a text. \param name What messages call it. */
WeightsFile weightsOfText(const std::string& text, const std::string& name,
                          const semantic_types::ClassTable& classes);

}  // namespace semantic_octree
