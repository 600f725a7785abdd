#pragma once
#include "SmallScans.h"

/** What random scans are made of. */
struct RandomScanOptions {
  int points = 400;
  int classes = 5;
  double reach = 7;         ///< meters, longest beam
  double sensorSpread = 3;  ///< meters, the sensor is this near to the origin
  double unlabeledShare = 0.2;
  double notFiniteShare = 0.02;
  bool softLabels = false;
};

/** Beams from a random pose into all directions, some ending close together with different labels.
 */
PosedCloud randomScan(std::mt19937& random, const RandomScanOptions& options = {});

Eigen::Isometry3d randomPose(std::mt19937& random, double spread);

/** Uniform in [low, high). */
double between(std::mt19937& random, double low, double high);
