#pragma once

namespace semantic_octree {

/** Sensor and classifier model of the class filter. */
struct FilterParameters {
  enum class Increments {
    /** Log-likelihood ratios of the probabilities below: occupancy follows the binary Bayes filter.
     */
    LikelihoodConsistent,
    /** The constants published with SSMI (Asgharivaskasi, Atanasov, "Active Bayesian Multi-class
     * Mapping from Range and Semantic Segmentation Observations"): +1 for the observed class, -0.1
     * for all others, -0.1 for a miss. The probabilities below are not used. */
    Ssmi
  };
  Increments increments = Increments::LikelihoodConsistent;

  /** Share of labels that name the true class, (1/K, 1). */
  double accuracy = 0.9;
  /** P(a return ends in the cell | the cell is occupied and a beam reaches it). */
  double hitProbability = 0.6;
  /** P(a return ends in the cell | the cell is free and a beam reaches it). */
  double falseAlarmProbability = 0.1;
  /** p(occupied) of a cell that was seen free for long: each class's log-odds stay above
   * ln(q / (1 - q)) - ln K. As OctoMap's lower clamping: a larger value merges more free space. */
  double minOccupancy = 0.12;
  /** The likeliest class's log-odds stay below ln(q / (1 - q)), as OctoMap's upper clamping. */
  double maxProbability = 0.97;
  /** Soft labels are raised to this before their logarithm is taken. */
  double softLabelFloor = 0.001;

  /** \throw std::invalid_argument naming the parameter and its value. */
  void validate(int numClasses) const;
  bool operator==(const FilterParameters& o) const;
};

}  // namespace semantic_octree
