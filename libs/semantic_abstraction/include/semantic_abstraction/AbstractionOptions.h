#pragma once
#include <semantic_types/ClassTable.h>
#include <strict_files/OptionList.h>
#include <tree_abstraction/AbstractionWeights.h>

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace semantic_octree {

/** A part of space that matters more, or less, than the rest. */
struct Region {
  enum class Shape {
    Box,      ///< from `a` (lowest corner) to `b` (highest corner)
    Sphere,   ///< center `a`, radius
    Corridor  ///< within `radius` of the line from `a` to `b`: one stretch of a path
  };
  Shape shape = Shape::Box;
  Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = Eigen::Vector3d::Zero();  ///< meters, map frame
  double radius = 0;                                                         ///< meters
  /** Density of p(x) inside, relative to 1 outside of all regions. Where regions overlap the
   * largest holds. */
  double weight = 1;

  /** "box x0 y0 z0 x1 y1 z1 weight", "sphere x y z radius weight" or
   * "corridor x0 y0 z0 x1 y1 z1 radius weight" */
  std::string text() const;
  /** \throw std::invalid_argument quoting the text: it is none of these. */
  static Region ofText(const std::string& text);
  /** \throw std::invalid_argument naming the field and its value. */
  void validate() const;
};
const strict_files::Choices<Region::Shape>& choicesOf(Region::Shape);

/** How the abstraction counts space, whatever its classes. */
struct AbstractionSpace {
  /** What is assumed of space without a node. */
  enum class Unknown {
    OwnClass,  ///< a value of its own: no class, not free either
    Uniform    ///< each of free and the K classes equally likely (the paper's)
  };
  Unknown unknown = Unknown::OwnClass;
  /** Edge of the blocks, meters; the next smaller power of two voxels is used. Unknown space counts
   * inside blocks that hold data, and nowhere else. 0: no blocks, the whole map counts. */
  double blockSize = 6;
  /** Nodes above the blocks; without a name in files. */
  enum class Frame {
    Free,    ///< always expanded, at no charge
    Charged  ///< expanded if that pays, as every other node (the paper's)
  };
  Frame frame = Frame::Free;

  void describe(strict_files::OptionList& list);
};
const strict_files::Choices<AbstractionSpace::Unknown>& choicesOf(AbstractionSpace::Unknown);

/** What the optimal abstraction of a semantic octree keeps. Files say the same by the classes'
 * names, see AbstractionText and WeightsFile. */
struct AbstractionOptions : AbstractionSpace {
  /** Terms over classes 0..K (0 = free space) and alpha. */
  tree_abstraction::AbstractionWeights weights;
  /** p(x): volume, times the weight of the region it lies in. */
  std::vector<Region> regions;

  /** \throw std::invalid_argument naming the field and its value. */
  void validate(int numClasses) const;
};

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
  /** Texts of regions, separated by semicolons: see Region::text(). */
  std::string regions;

  bool isSet() const { return !relevant.empty() || !irrelevant.empty() || everything != 0; }
  /** The options for a map of these classes.
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
/** Reads weights from a text. \param name What messages call it. */
WeightsFile weightsOfText(const std::string& text, const std::string& name,
                          const semantic_types::ClassTable& classes);

/** All informations to be measured, each once: first the classes (0 = free space to K), then the
 * groups and whole class variables of the solutions. They all are terms of one abstraction, so that
 * another solution is a change of weights only.
 *
 * Many classes would take much memory at once: they come in batches, each of which has all terms
 * that some solution weighs. */
class TermCatalog {
 public:
  TermCatalog(const semantic_types::ClassTable& classes, const std::vector<Solution>& solutions);

  std::size_t size() const { return m_terms.size(); }
  std::size_t numClasses() const { return m_numClasses; }
  const std::string& name(std::size_t term) const { return m_terms[term].name; }

  std::size_t numBatches() const { return m_batches.size(); }
  /** Indices of a batch's terms. */
  const std::vector<std::size_t>& batch(std::size_t b) const { return m_batches[b]; }
  /** The terms themselves, with weight 0. */
  std::vector<tree_abstraction::InformationTerm> terms(std::size_t b) const;
  /** A batch's terms with the weights that a solution gives them. */
  std::vector<tree_abstraction::InformationTerm> weighedTerms(const Solution& solution,
                                                              std::size_t b) const;
  /** Weight of each term in a solution. */
  std::vector<double> allWeights(const Solution& solution) const;
  /** Weight of each of the batch's terms in a solution. */
  std::vector<double> weights(const Solution& solution, std::size_t b) const;

 private:
  std::size_t indexOf(const tree_abstraction::InformationTerm& term) const;
  void add(tree_abstraction::InformationTerm term);
  void makeBatches(const std::vector<bool>& isWeighed);

  std::size_t m_numClasses;
  std::vector<tree_abstraction::InformationTerm> m_terms;
  std::vector<std::vector<std::size_t>> m_batches;
};

}  // namespace semantic_octree
