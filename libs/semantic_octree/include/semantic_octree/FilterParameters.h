#pragma once
#include <strict_files/OptionList.h>

#include <vector>

namespace semantic_octree {

/** How what a map states of a voxel's classes follows from what its filter believes of them: with
 * p_k the filter's p(class k | occupied), the map states
 *
 *   (1 - shared) w_k p_k^power / sum_j w_j p_j^power + shared u_k,
 *
 * u_k = 1 / n for the n classes that the voxel's record names and 0 for the others. A power below 1
 * says that labels err more often, or repeat each other more, than the filter takes them to. What
 * is shared says that voxels hold several classes. A factor w_k below 1 says that labels name a
 * class too often: it is rare, or others are taken for it (Alexandari et al., "Maximum Likelihood
 * with Bias-Corrected Calibration is Hard-To-Beat at Label Shift Adaptation", 2020). Without
 * factors the order of classes stays. */
struct Calibration {
  static constexpr double kMostFactor = 65536;

  double power = 1;   ///< (0, 4]
  double shared = 0;  ///< [0, 1)
  /** w_k of the classes 1 to K, 1/65536 to 65536; empty: all are 1. */
  std::vector<double> factors = {};

  bool isIdentity() const { return power == 1 && shared == 0 && factors.empty(); }
  bool operator==(const Calibration& o) const {
    return power == o.power && shared == o.shared && factors == o.factors;
  }
};

/** Sensor and classifier model of the class filter: log-likelihood ratios of these probabilities
 * are added, so that occupancy follows the binary Bayes filter. */
struct FilterParameters {
  /** Share of labels that name the true class, (1/K, 1). Of scans whose labels disagree in cells
   * more than that allows, it is less (LabelAgreement). Annotated labels are right in 98 to 99 of
   * 100, those of good segmentation networks in 90 to 95. The default lies between. */
  double accuracy = 0.93;
  /** Largest correlation of any two labels of one scan in one cell, given the cell's class, [0, 1].
   * 0: each counts by itself, 1: many that agree say no more than one. What errs about a surface
   * errs about most of its points. Of scans whose labels disagree more, it is less, too. */
  double labelCorrelation = 0.8;
  /** P(a return ends in the cell | the cell is occupied and a beam of the scan reaches it).
   * Surfaces fill cells in part, and beams that graze one pass through cells that it crosses. In
   * SemanticKITTI it is 0.42 to 0.69 for cells of 0.1 to 0.4 m, in a flat before a depth camera
   * 0.87 to 0.9. */
  double hitProbability = 0.5;
  /** P(a return ends in the cell | the cell is free and a beam of the scan reaches it). A return
   * outweighs four beams that pass; with less, ground seen at grazing angles erodes. Real sensors
   * have 0.0002 to 0.004, to which this leaves room for objects that move. */
  double falseAlarmProbability = 0.03;

  // Without a name in files.
  /** p(occupied) of a cell that was seen free for long: each class's log-odds stay above
   * ln(q / (1 - q)) - ln K. As OctoMap's lower clamping: a larger value merges more free space. */
  double minOccupancy = 0.12;
  /** The likeliest class's log-odds stay below ln(q / (1 - q)), as OctoMap's upper clamping. */
  double maxProbability = 0.97;
  /** Soft labels are raised to this before their logarithm is taken. */
  double softLabelFloor = 0.001;
  /** Set by whoever measures it (Calibrator); files keep it. */
  Calibration calibration;
  /** p(class k) of voxels before the first row of probabilities of theirs, K numbers; empty: all
   * are alike. For rows that are likelihoods, as those of a confusion matrix. Files do not keep it.
   */
  std::vector<float> classPrior;

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the parameter and its value. */
  void validate(int numClasses) const;
  /** Whether beliefs come about in the same way; the calibration, which follows from scans, and
   * the prior, which files do not keep, do not matter. */
  bool operator==(const FilterParameters& o) const;
};

}  // namespace semantic_octree
