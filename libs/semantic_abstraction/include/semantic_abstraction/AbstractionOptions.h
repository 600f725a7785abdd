#pragma once
#include <semantic_types/ClassTable.h>
#include <strict_files/OptionList.h>
#include <tree_abstraction/AbstractionWeights.h>

#include <Eigen/Core>
#include <filesystem>
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

/** Name of class 0 in files and reports. */
constexpr const char* kFreeSpace = "free_space";

/** What the optimal abstraction of a semantic octree keeps, however it is said: in a struct, an
 * .ini file, a file of weights, or Python. */
struct AbstractionOptions {
  std::string name;  ///< of a file's solution: letters, digits, '-' and '_', for files are named so

  /** Classes worth keeping and worth dropping by their names, with their weights (beta, gamma),
   * "road: 1, car: 0.5". Several classes that count as one are joined by "+": "road+parking: 1". */
  std::string relevant, irrelevant;
  /** Weight of the whole class variable (which class it is, or free); negative: worth dropping. */
  double everything = 0;
  /** Terms over classes 0..K (0 = free space), which come behind those by name, and alpha. */
  tree_abstraction::AbstractionWeights weights;

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
  /** p(x): volume, times the weight of the region it lies in. */
  std::vector<Region> regions;
  /** More of them, by their texts, separated by semicolons: see Region::text(). */
  std::string regionTexts;

  /** Whether anything has a weight. */
  bool isSet() const;
  /** A term by the names of its classes. \param members several count as one
   * \param weight below 0 where they are irrelevant
   * \throw std::invalid_argument no such class, one twice, or two terms of one name. */
  void add(const semantic_types::ClassTable& classes, const std::string& term,
           const std::vector<std::string>& members, double weight);
  /** These options without names and texts, in `weights` and `regions` alone.
   * \throw std::invalid_argument naming the option and its value, or a class that is both relevant
   * and irrelevant. */
  AbstractionOptions forClasses(const semantic_types::ClassTable& classes) const;
  /** What files can say: all but `frame`, and `weights.terms` and `regions`. */
  void describe(strict_files::OptionList& list);
  /** Checks all but what depends on the classes. \throw std::invalid_argument */
  void validate() const;
};
const strict_files::Choices<AbstractionOptions::Unknown>& choicesOf(AbstractionOptions::Unknown);

/** Reads one solution or a list `solutions` (YAML), each with what the file says of all; the syntax
 * stands in the README of semantic-map-compress.
 * \param alpha of solutions that state none
 * \throw std::runtime_error naming file, line, key and value: unreadable, unknown or repeated key,
 * a class that is not in the table or both relevant and irrelevant. A weight or alpha that is not a
 * number >= 0. A solution without weights, or two of one name. */
std::vector<AbstractionOptions> loadWeights(const std::filesystem::path& file,
                                            const semantic_types::ClassTable& classes,
                                            double alpha = tree_abstraction::kAlpha);
/** Reads weights from a text. \param name What messages call it. */
std::vector<AbstractionOptions> weightsOfText(const std::string& text, const std::string& name,
                                              const semantic_types::ClassTable& classes,
                                              double alpha = tree_abstraction::kAlpha);
/** \param wanted a solution's name; empty: the first \param source what messages call where they
 * are from \throw std::runtime_error naming that: it has none of this name. */
AbstractionOptions solutionIn(const std::vector<AbstractionOptions>& solutions,
                              const std::string& wanted, const std::string& source);
/** A solution of a file: see loadWeights() and solutionIn(). */
inline AbstractionOptions loadSolution(const std::filesystem::path& file, const std::string& wanted,
                                       const semantic_types::ClassTable& classes) {
  return solutionIn(loadWeights(file, classes), wanted, file.string());
}

/** All informations to be measured, each once: first the classes (0 = free space to K), then the
 * groups and whole class variables of the solutions. They all are terms of one abstraction, so that
 * another solution is a change of weights only. */
class TermCatalog {
 public:
  TermCatalog(const semantic_types::ClassTable& classes,
              const std::vector<AbstractionOptions>& solutions);

  std::size_t size() const { return m_terms.size(); }
  std::size_t numClasses() const { return m_numClasses; }
  const std::string& name(std::size_t term) const { return m_terms[term].name; }

  /** Which term is which of the abstraction's: those that some solution weighs come first, so that
   * their sums do not depend on what is measured beside. */
  const std::vector<std::size_t>& order() const { return m_order; }
  /** The abstraction's terms with the weights that a solution gives them. */
  std::vector<tree_abstraction::InformationTerm> terms(const AbstractionOptions& solution) const;
  /** These weights alone. */
  std::vector<double> weights(const AbstractionOptions& solution) const;

 private:
  std::size_t indexOf(const tree_abstraction::InformationTerm& term) const;
  void add(tree_abstraction::InformationTerm term);

  std::size_t m_numClasses;
  std::vector<tree_abstraction::InformationTerm> m_terms;
  std::vector<std::size_t> m_order;
};

}  // namespace semantic_octree
