#include <semantic_abstraction/AbstractionOptions.h>

#include <cmath>
#include <numeric>

namespace semantic_octree {

using strict_files::atLeast;
using strict_files::between;
using strict_files::checkOptions;
using strict_files::Choices;
using strict_files::OptionList;
using strict_files::require;

const Choices<Region::Shape>& choicesOf(Region::Shape) {
  using Shape = Region::Shape;
  static const Choices<Shape> choices = {
      {"box", Shape::Box}, {"sphere", Shape::Sphere}, {"corridor", Shape::Corridor}};
  return choices;
}

void Region::validate() const {
  require(a.allFinite(), "corner of a region", a.sum(), "finite coordinates");
  if (shape != Shape::Sphere)  // which has no other corner
    require(b.allFinite(), "corner of a region", b.sum(), "finite coordinates");
  require(weight >= 0 && std::isfinite(weight), "weight of a region", weight,
          "a number of 0 or more");
  if (shape == Shape::Box)
    require((a.array() <= b.array()).all(), "edge of a box", (b - a).minCoeff(),
            "the lowest corner first");
  else
    require(radius > 0 && std::isfinite(radius), "radius of a region", radius, "a number above 0");
}

const Choices<AbstractionSpace::Unknown>& choicesOf(AbstractionSpace::Unknown) {
  using Unknown = AbstractionSpace::Unknown;
  static const Choices<Unknown> choices = {
      {"own_class", Unknown::OwnClass}, {"uniform", Unknown::Uniform}, {"prior", Unknown::Prior}};
  return choices;
}

const Choices<AbstractionSpace::Frame>& choicesOf(AbstractionSpace::Frame) {
  using Frame = AbstractionSpace::Frame;
  static const Choices<Frame> choices = {{"free", Frame::Free}, {"charged", Frame::Charged}};
  return choices;
}

void AbstractionSpace::describe(OptionList& list) {
  list.add(
      "block_size", blockSize, "m", atLeast(0),
      "edge of the blocks inside which unknown space counts, the coarsest cells; 0: no blocks");
  list.add("unknown", unknown, "",
           "what unknown space is taken for: a value of its own, all classes alike, or prior");
  list.add("unknown_weight", unknownWeight, "", between(0, 1),
           "weight of unknown space beside known space");
  list.add("frame", frame, "", "whether nodes above the blocks cost anything");
}

void AbstractionOptions::validate(int numClasses) const {
  checkOptions<AbstractionSpace>(*this, "AbstractionOptions");
  weights.validate(numClasses);
  for (const Region& region : regions) region.validate();
  if (prior.empty()) return;
  require(static_cast<int>(prior.size()) == numClasses + 1, "size of AbstractionOptions::prior",
          static_cast<double>(prior.size()), "number of classes + 1");
  for (const double p : prior)
    require(p >= 0 && p <= 1, "AbstractionOptions::prior", p, "a probability");
  const double sum = std::accumulate(prior.begin(), prior.end(), 0.0);
  require(std::fabs(sum - 1) < 1e-6, "sum of AbstractionOptions::prior", sum, "1");
}

}  // namespace semantic_octree
