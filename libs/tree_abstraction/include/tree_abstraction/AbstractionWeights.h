#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace tree_abstraction {

/** One information the abstraction keeps or drops: a variable made of classes, and its weight.
 *
 * Classes are 0..K, where 0 is free space. The variable's outcomes are the groups and, if they
 * leave any class over, the rest. So {{3}} is "class 3 or not", {{1, 2}} is "1 or 2, or not",
 * {{1, 2}, {5}} tells three things apart, and {{0}, {1}, ..., {K}} is the whole class variable. */
struct InformationTerm {
  std::string name;
  /** > 0: relevant (beta), to be kept; < 0: irrelevant (-gamma), to be dropped; 0: measured only.
   */
  double weight = 0;
  std::vector<std::vector<int>> groups;
};

/** Relevant information "one of `classes` or not".
 * \throw std::invalid_argument beta < 0 or not finite. */
InformationTerm relevant(std::string name, double beta, std::vector<int> classes);
/** Irrelevant information "one of `classes` or not".
 * \throw std::invalid_argument gamma < 0 or not finite. */
InformationTerm irrelevant(std::string name, double gamma, std::vector<int> classes);
/** The whole class variable with its K + 1 outcomes. */
InformationTerm wholeClassVariable(std::string name, double weight, int numClasses);

/** A price of detail (AbstractionWeights::alpha) that serves. */
constexpr double kAlpha = 0.002;

/** What the compressed tree maximizes: J(T) = sum_t weight_t I_t(T) - alpha I_X(T). */
struct AbstractionWeights {
  std::vector<InformationTerm> terms;
  /** Price of a nat of I_X, the entropy of the leaf that holds a random point of space; >= 0. */
  double alpha = kAlpha;

  /** Checks all fields for a map of numClasses classes (K; free space not counted).
   * \throw std::invalid_argument naming the field and its value: a weight or alpha that is not
   * finite, or alpha < 0. Groups that are missing or empty, with a class outside 0..K, or with a
   * class in two groups of a term. Two terms of one name. */
  void validate(int numClasses) const;

  /** G-values (per unit of p(n)) up to this count as 0: rounding must not expand a tie. */
  double eps() const;
};

/** Entropies and informations of a tree's leaves, in nats. */
struct TreeMeasures {
  /** I_X: entropy of the leaf that holds a random point. */
  double leafEntropy = 0;
  /** I_t per term: what the leaf says about the term's variable. */
  std::vector<double> information;
  std::size_t numLeaves = 0, numKnownLeaves = 0;

  /** J: sum of weight times information, less alpha times leaf entropy. */
  double objective(const AbstractionWeights& weights) const;
};

/** How the terms' outcome probabilities stand in one row of doubles per tree node.
 *
 * A row holds each term's probabilities one after the other. A yes-or-no term (one group and a
 * rest) takes one double, the group's probability; any other term takes one double per outcome, its
 * rest last. Rows mix linearly: the parent's row is the mixture of its children's. */
class TermSet {
 public:
  /** Where a term's probabilities stand in a row. */
  struct Slot {
    std::size_t offset, width;
    bool isBinary() const { return width == 1; }
  };

  /** The probability of a class is added to row[entry]. */
  struct Contribution {
    std::size_t classId, entry;
  };

  /** \throw std::invalid_argument as AbstractionWeights::validate(). */
  TermSet(const AbstractionWeights& weights, int numClasses);

  int numClasses() const { return m_numClasses; }
  /** Number of terms. */
  std::size_t size() const { return m_slots.size(); }
  /** Number of doubles in a row. */
  std::size_t width() const { return m_width; }
  Slot slot(std::size_t term) const { return m_slots[term]; }

  /** What a row is made of, by ascending entry. */
  const std::vector<Contribution>& contributions() const { return m_contributions; }

 private:
  int m_numClasses;
  std::size_t m_width = 0;
  std::vector<Slot> m_slots;
  std::vector<Contribution> m_contributions;
};

}  // namespace tree_abstraction
