#pragma once
#include <semantic_abstraction/AbstractionOptions.h>

/** Posts matter, the ground's classes are held against them, and all classes count a little: with
 * blocks of 3.2 m. \param all weight of the latter */
inline semantic_octree::AbstractionOptions threeTerms(double alpha, int classes, double all) {
  using namespace tree_abstraction;
  semantic_octree::AbstractionOptions options;
  options.weights = {{relevant("posts", 1.0, {1}), irrelevant("ground", 0.3, {2, 3}),
                      wholeClassVariable("everything", all, classes)},
                     alpha};
  options.blockSize = 3.2;
  return options;
}
