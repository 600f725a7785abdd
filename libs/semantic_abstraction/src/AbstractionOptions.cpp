#include <semantic_abstraction/AbstractionOptions.h>
#include <strict_files/TextFile.h>

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace semantic_octree {

using strict_files::atLeast;
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

std::string Region::text() const {
  std::ostringstream out;
  const strict_files::ClassicNumbers classic(out);
  const auto add = [&out](double number) { out << ' ' << strict_files::textOf(number); };
  out << strict_files::nameIn(choicesOf(shape), shape);
  for (const double x : a) add(x);
  if (shape != Shape::Sphere)
    for (const double x : b) add(x);
  if (shape != Shape::Box) add(radius);
  add(weight);
  return out.str();
}

Region Region::ofText(const std::string& text) {
  const auto refuse = [&text](const std::string& why) {
    throw std::invalid_argument("'" + text + "', expected " + why);
  };
  std::istringstream in(text);
  const strict_files::ClassicNumbers classic(in);
  std::string shape, rest;
  Region region;
  in >> shape;
  bool known = false;
  for (const auto& [name, value] : choicesOf(region.shape))
    if (shape == name) region.shape = value, known = true;
  if (!known) refuse("box, sphere or corridor first");
  for (double& x : region.a) in >> x;
  if (region.shape != Shape::Sphere)
    for (double& x : region.b) in >> x;
  if (region.shape != Shape::Box) in >> region.radius;
  in >> region.weight;
  if (!in || in >> rest) refuse("the numbers of this shape and a weight");
  try {
    region.validate();
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument("'" + text + "': " + e.what());
  }
  return region;
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
  static const Choices<Unknown> choices = {{"own_class", Unknown::OwnClass},
                                           {"uniform", Unknown::Uniform}};
  return choices;
}

void AbstractionSpace::describe(OptionList& list) {
  list.add(
      "block_size", blockSize, "m", atLeast(0),
      "edge of the blocks inside which unknown space counts, the coarsest cells; 0: no blocks");
  list.add("unknown", unknown, "",
           "what unknown space is taken for: a value of its own, or all classes alike");
}

void AbstractionOptions::validate(int numClasses) const {
  checkOptions<AbstractionSpace>(*this, "AbstractionOptions");
  weights.validate(numClasses);
  for (const Region& region : regions) region.validate();
}

}  // namespace semantic_octree
