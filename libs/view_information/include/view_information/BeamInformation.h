#pragma once
#include <semantic_octree/ClassFilter.h>
#include <tree_abstraction/AbstractionWeights.h>

#include <cstddef>
#include <vector>

/** \file
 * What beams and views tell, in nats: exact under the model that the class filter inverts. The
 * formulas (a) to (h) stand in doc/how-it-works/exploration.md. */

namespace view_information {

using semantic_octree::ClassId;

/** Where a number lies. */
struct Bounds {
  double lower = 0, upper = 0;
};
/** The sensor model of the class filter. A cell is free (0) or of a class (1..K); a beam that
 * reaches it passes on (outcome 0) or returns with a label (outcome 1..K). */
class BeamModel {
 public:
  /** \throw std::invalid_argument K < 1 or bad parameters. */
  BeamModel(int numClasses, const semantic_octree::FilterParameters& parameters);

  int numClasses() const { return m_numClasses; }
  /** P(outcome | cell). */
  double probability(int outcome, int cell) const;
  /** P(outcome) of a cell with K + 1 probabilities p, p[0] = free. */
  double probability(int outcome, const double* p) const;
  /** What is believed of the cell after an outcome, which is possible. */
  std::vector<double> after(int outcome, const double* p) const;
  /** P(a beam that reaches the cell passes on). */
  double pass(const double* p) const { return probability(0, p); }

 private:
  int m_numClasses;
  double m_hit, m_falseAlarm, m_accuracy;
};

/** What somebody wants to know of a cell: sum of beta_i Y_i less sum of gamma_j Z_j, by the terms
 * of the abstraction's weights as they are. */
class Question {
 public:
  /** \throw std::invalid_argument as AbstractionWeights::validate(). */
  Question(const tree_abstraction::AbstractionWeights& weights, int numClasses);

  int numClasses() const { return m_terms.numClasses(); }
  /** Weighted entropy H of K + 1 probabilities. */
  double entropy(const double* p) const;
  double entropy(const semantic_octree::ClassBelief& belief) const;
  /** (c): what the outcome of a beam that reaches the cell tells. It may be negative: looking is no
   * loss then, but worth nothing. */
  double information(const BeamModel& model, const double* p) const;
  /** Weighted divergence of the terms of p from q, K + 1 probabilities each: below 0 where what is
   * to be ignored moved more. */
  double divergence(const double* p, const double* q) const;
  /** How far a mean over many moves when one's belief moves from q to p: weighted chi-square
   * distance of ignored (lower) and relevant (upper) terms. */
  Bounds distance(const double* p, const double* q, const double* mean) const;
  /** (g): how far an outcome moves what is believed of a cell, the weighted divergence of the terms
   * after it from before. Its mean over the outcomes as the belief predicts them is information().
   */
  double surprise(const BeamModel& model, const double* p, int outcome) const;
  /** (d): the expected fall of entropy when the filter gets the outcome, with its limits; below 0
   * as above. At limits the filter forgets: of what is to be ignored that is no gain. */
  double fallThrough(const semantic_octree::ClassFilter& filter, const BeamModel& model,
                     const semantic_octree::ClassBelief& belief) const;
  /** A class of each kind: no term tells classes of one kind apart. \return for each class 1..K the
   * first class of its kind; [0] is not used */
  const std::vector<int>& kinds() const { return m_kinds; }

 private:
  std::vector<double> rowOf(const double* p) const;
  Bounds entropies(const semantic_octree::ClassBelief& belief) const;
  Bounds entropiesOfRow(const std::vector<double>& row) const;
  template <class Of, class OfRest>
  Bounds sumsOverTerms(Of of, OfRest ofRest) const;

  std::vector<double> m_weights;
  tree_abstraction::TermSet m_terms;
  std::vector<std::vector<std::size_t>> m_entries;  ///< of each class 0..K in a row
  std::vector<double> m_sizes;                      ///< classes 1..K in each entry of a row
  std::vector<int> m_kinds;
};

/** A stretch of equal cells along a beam. */
struct CellRun {
  double pass = 1;   ///< P(a beam that reaches the first cell passes it)
  double value = 0;  ///< what an observation of one of them tells
  int count = 1;
};
/** (b): what a beam tells, sum of P(reached) times value over its cells. */
double informationOfBeam(const std::vector<CellRun>& runs);

/** A cell of a view in which each cell is reached through one other. */
struct TreeCell {
  int parent = -1;  ///< index of a cell before this one; -1: the sensor is there
  double pass = 1, value = 0;
};
/** (e): what a view tells if each cell is observed once, as a scan is inserted. */
double informationOfTree(const std::vector<TreeCell>& cells);

/** (e): what a view of beams that cross tells, each cell observed once. A cell is reached at least
 * as surely as by its best beam, and at most as if the beams were independent (Harris).
 * \param cells without regard to their parents \param beams indices of cells in order */
Bounds informationOfNet(const std::vector<TreeCell>& cells,
                        const std::vector<std::vector<int>>& beams);
/** (h): what a view is expected to add to sum of weights times I_Y(T), the objective without the
 * price of leaves. The tree has the cells as leaves, as equal shares of its space. The upper bound
 * has what is told of each cell. How far the mean over all cells moves, which is less, is not taken
 * off.
 * \param beliefs K + 1 probabilities of each cell, as the map has them \param reached P(reached) of
 * each \param counts for how many cells of the tree each stands */
Bounds growthOfTree(const Question& question, const BeamModel& model,
                    const std::vector<std::vector<double>>& beliefs,
                    const std::vector<double>& reached, const std::vector<double>& counts);
/** (f): what several views tell together. \param reached P(reached) by view and cell
 * \param values of each cell */
Bounds informationOfViews(const std::vector<std::vector<double>>& reached,
                          const std::vector<double>& values);

}  // namespace view_information
