#pragma once
#include <semantic_octree/ClassBelief.h>
#include <semantic_octree/FilterParameters.h>
#include <semantic_octree/LabelEvidence.h>
#include <semantic_octree/LabelReliability.h>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace semantic_octree {

/** A map's log-odds are multiples of 1/1024, up to 31.99 on either side of 0: they fit into 16
 * bits, and their sums are exact. */
constexpr int kUnitsPerLogOdds = 1024;

/** The nearest of these values (beyond 31.99, too). */
inline float onGrid(double logOdds) {
  return static_cast<float>(std::round(logOdds * kUnitsPerLogOdds) / kUnitsPerLogOdds);
}

/** How many of a scan's labels in one cell name a class. */
struct ClassVotes {
  ClassId id;
  std::uint32_t count;
};

/** Bayes filter over {free, class 1, ..., class K} of one cell, truncated to the likeliest classes.
 *
 * An observation z adds ln(p(z | class k) / p(z | free)) to each h_k. Then, if the likeliest class
 * is above its limit, all are lowered by the excess. Clamping one by one would make equal what is
 * not. Each is clamped from below.
 *
 * A class seen for the first time begins with the rest's value. If more than three classes are
 * named, the least likely one (largest id on a tie) joins the rest. The rest's value becomes the
 * logarithm of the mean odds of its members.
 *
 * Increments, limits and the prior are on the grid of onGrid(), and adding them
 * is exact. So away from the limits the order of observations does not matter, not even to the last
 * bit. */
class ClassFilter {
 public:
  using Belief = ClassBelief;

  /** \throw std::invalid_argument K < 1 or bad parameters. */
  ClassFilter(int numClasses, const FilterParameters& parameters);

  int numClasses() const { return m_numClasses; }
  const FilterParameters& parameters() const { return m_parameters; }
  /** This filter for a scan whose labels are trusted otherwise. */
  ClassFilter trusting(const LabelReliability& labels) const;

  /** A return with a class label ended in the cell. */
  void hit(Belief& b, ClassId id) const {
    const ClassVotes votes{id, 1};
    hit(b, &votes, 1);
  }
  /** Returns of one scan with labels ended in the cell, n_k of them of class k. They are one
   * observation with q_k proportional to exp(f(n_k)), f = LabelEvidence. The q of a single label is
   * (accuracy, (1 - accuracy) / (K - 1), ...). Labels of one scan that agree add less than scans
   * that do, and a tie says that either class may be.
   * \param votes numVoted > 0 classes, ascending ids, counts > 0 */
  void hit(Belief& b, const ClassVotes* votes, std::size_t numVoted) const;
  /** A return without a label ended in the cell: every class gains equally. */
  void hit(Belief& b) const { addToAll(b, m_hitUnlabeled); }
  /** A return with a soft label ended in the cell. The first one meets the parameters' prior.
   * \param q K probabilities of classes 1..K. */
  void hit(Belief& b, const float* q) const;
  /** A beam passed through the cell. */
  void miss(Belief& b) const { addToAll(b, m_miss); }

  /** Cell whose classes are equally likely, given its occupancy's log-odds. */
  Belief uniform(float occupancyLogOdds) const;
  /** What is stated of a cell's classes (see Calibration); its occupancy is the belief's. With
   * factors it names the likeliest classes, whether the belief names them or not. */
  Belief stated(const Belief& b) const;
  /** What stated() says as K + 1 probabilities, p[0] = free. With factors, classes that are not
   * named have their own. */
  void distribution(const Belief& b, double* p) const;
  /** Occupancy of a cell with a class record, ln(p(occupied) / p(free)); on the grid. */
  float occupancyOf(const Belief& b) const;
  /** The log-odds that uniform() of a cell had, given its rest. */
  float occupancyOfUniform(float rest) const { return rest + m_logNumClasses; }

  /** Occupancy log-odds of a cell without a class record after another miss or unlabeled hit: the
   * same as the filter's on uniform(), without the detour. */
  float occupancyAfterMiss(float v) const { return limitedOccupancy(v + m_miss); }
  float occupancyAfterUnlabeledHit(float v) const { return limitedOccupancy(v + m_hitUnlabeled); }
  /** The value that further misses leave as it is. */
  float lowestOccupancy() const { return m_min + m_logNumClasses; }
  float highestOccupancy() const { return m_max + m_logNumClasses; }
  /** What a miss adds to log-odds, away from the limits. */
  float missIncrement() const { return m_miss; }
  /** Puts all values into their limits and restores the order. */
  void limit(Belief& b) const;
  /** The limits for the occupancy of a cell without a class record. */
  float limitedOccupancy(float v) const {
    return std::min(highestOccupancy(), std::max(lowestOccupancy(), v));
  }

 private:
  Belief statedWithFactors(const Belief& b) const;
  /** p(class k + 1 | occupied) as it is stated with factors. */
  std::array<double, semantic_types::kMaxClasses> classesWithFactors(const Belief& b) const;
  void addToAll(Belief& b, float increment) const;
  void hitOf(Belief& b, ClassId id, float same, float other) const;
  void hitOfSeveral(Belief& b, const ClassVotes* votes, std::size_t numVoted) const;
  void name(Belief& b, ClassId id, float logOdds) const;
  /** What labels of one scan that agree add to their class and to each other one. */
  struct Row {
    float named, other;
  };
  Row rowOf(std::uint32_t numLabels) const;
  /** What labels add to a class without evidence, not rounded; each class adds its evidence to it.
   * \param most the largest evidence \param odds sum of exp(evidence - most) over all classes */
  double incrementWithoutEvidence(double most, double odds) const;

  int m_numClasses;
  FilterParameters m_parameters;
  float m_logNumClasses, m_min, m_max;
  float m_hitUnlabeled, m_miss;
  double m_unlabeled;  ///< not rounded
  LabelEvidence m_evidence;
  /** By number of labels; empty with a single class. */
  std::vector<Row> m_rowsOfFew;
};

}  // namespace semantic_octree
