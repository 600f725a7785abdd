#pragma once
#include <strict_files/OptionList.h>
#include <tree_abstraction/AbstractionWeights.h>

#include <Eigen/Core>
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

  /** \throw std::invalid_argument naming the field and its value. */
  void validate() const;
};
const strict_files::Choices<Region::Shape>& choicesOf(Region::Shape);

/** How the abstraction counts space, whatever its classes. */
struct AbstractionSpace {
  /** What is assumed of space without a node. */
  enum class Unknown {
    OwnClass,  ///< a value of its own: no class, not free either
    Uniform,   ///< each of free and the K classes equally likely (the paper's)
    Prior      ///< AbstractionOptions::prior
  };
  Unknown unknown = Unknown::OwnClass;
  /** Weight of unknown space relative to known space of the same volume, [0, 1]. */
  double unknownWeight = 1;

  /** Edge of the blocks, meters; the next smaller power of two voxels is used. Unknown space counts
   * inside blocks that hold data, and nowhere else. 0: no blocks, the whole map counts. */
  double blockSize = 6;
  /** Nodes above the blocks. */
  enum class Frame {
    Free,    ///< always expanded, at no charge
    Charged  ///< expanded if that pays, as every other node (the paper's)
  };
  Frame frame = Frame::Free;

  void describe(strict_files::OptionList& list);
};
const strict_files::Choices<AbstractionSpace::Unknown>& choicesOf(AbstractionSpace::Unknown);
const strict_files::Choices<AbstractionSpace::Frame>& choicesOf(AbstractionSpace::Frame);

/** What the optimal abstraction of a semantic octree keeps. Files say the same by the classes'
 * names, see AbstractionText and WeightsFile. */
struct AbstractionOptions : AbstractionSpace {
  /** Terms over classes 0..K (0 = free space) and alpha. */
  tree_abstraction::AbstractionWeights weights;
  /** K + 1 probabilities for Unknown::Prior; empty: p(free) = 1/2, the classes equally likely. */
  std::vector<double> prior;
  /** p(x): volume, times the weight of the region it lies in. */
  std::vector<Region> regions;

  /** \throw std::invalid_argument naming the field and its value. */
  void validate(int numClasses) const;
};

}  // namespace semantic_octree
