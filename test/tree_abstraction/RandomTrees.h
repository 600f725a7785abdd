#pragma once
#include <reference/GTreeSearch.h>

#include <random>
#include <vector>

/** Random trees and weights for tests and benchmarks, the same for the same seed on every machine.
 */
namespace random_trees {

using Engine = std::mt19937;

/** Uniform in [0, 1). (Those of the standard library differ from one to the other.) */
double uniform(Engine& random);
/** Uniform in low..high, both included. */
int uniformInt(Engine& random, int low, int high);

struct Shape {
  int depth = 3;
  int minArity = 4, maxArity = 4;
  /** Probability that an inner node above the deepest level is split further. */
  double splitProbability = 1.0;
  /** Probability that a leaf is a missing child, of uniform distribution. */
  double missingProbability = 0.0;
  int numClasses = 2;
  int numRoots = 1;
  /** Class 1 or not (numClasses = 1) in patterns, and weights the node's volume: many ties. */
  bool tieRich = false;
};

/** Some leaf has a weight. */
reference::Forest makeTree(const Shape& shape, Engine& random);

/** Class 1 relevant, class 2 (if any) irrelevant, with random weights and alpha. Tie-rich shapes
 * get weights at which many splits cost just what they tell. */
tree_abstraction::AbstractionWeights makeWeights(const Shape& shape, Engine& random);

/** A random distribution over `size` outcomes; some entries 0. */
std::vector<double> makeDistribution(std::size_t size, Engine& random);

}  // namespace random_trees
