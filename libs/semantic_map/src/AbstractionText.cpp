#include <mrpt/system/string_utils.h>
#include <semantic_map/MapOptions.h>

#include <sstream>
#include <stdexcept>

#include "OptionText.h"

namespace semantic_map {

using semantic_octree::AbstractionOptions;
using semantic_octree::Region;
using semantic_types::ClassTable;
using tree_abstraction::InformationTerm;

namespace {

/** The parts of a text between separators, without the spaces around them; no empty ones. */
std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);)
    if (part = mrpt::system::trim(part); !part.empty()) parts.push_back(part);
  return parts;
}

[[noreturn]] void refuse(const char* option, const std::string& value,
                         const std::string& expected) {
  throw std::invalid_argument(std::string(option) + ": '" + value + "', expected " + expected);
}

double numberIn(const char* option, const std::string& text) {
  double number;
  try {
    parseOption(text, number);
  } catch (const std::invalid_argument& expected) {
    refuse(option, text, expected.what());
  }
  return number;
}

/** One or more classes joined by "+". */
std::vector<int> classesIn(const char* option, const std::string& text, const ClassTable& classes) {
  std::vector<int> ids;
  for (const std::string& name : split(text, '+')) {
    const auto id = classes.find(name);
    if (!id) refuse(option, name, "a class of the table");
    ids.push_back(*id);
  }
  return ids;
}

struct WeightedName {
  std::string name;
  double weight;
};

/** "road: 1, car+truck: 0.5" */
std::vector<WeightedName> weightsIn(const char* option, const std::string& text) {
  std::vector<WeightedName> weights;
  for (const std::string& entry : split(text, ',')) {
    const std::size_t colon = entry.rfind(':');
    if (colon == std::string::npos) refuse(option, entry, "a class and its weight, \"road: 1\"");
    const double weight = numberIn(option, mrpt::system::trim(entry.substr(colon + 1)));
    if (!(weight >= 0)) refuse(option, entry, "a weight of 0 or more");
    weights.push_back({mrpt::system::trim(entry.substr(0, colon)), weight});
  }
  return weights;
}

Region regionIn(const std::string& text) {
  std::istringstream in(text);
  std::string shape, rest;
  Region region;
  in >> shape;
  if (shape == "box")
    region.shape = Region::Shape::Box;
  else if (shape == "sphere")
    region.shape = Region::Shape::Sphere;
  else if (shape == "corridor")
    region.shape = Region::Shape::Corridor;
  else
    refuse("regions", text, "box, sphere or corridor first");
  in >> region.a.x() >> region.a.y() >> region.a.z();
  if (region.shape != Region::Shape::Sphere) in >> region.b.x() >> region.b.y() >> region.b.z();
  if (region.shape != Region::Shape::Box) in >> region.radius;
  in >> region.weight;
  if (!in || in >> rest) refuse("regions", text, "the numbers of this shape and a weight");
  region.validate();
  return region;
}

}  // namespace

AbstractionOptions TAbstractionOptions::forClasses(const ClassTable& classes) const {
  AbstractionOptions o;
  for (const auto& [name, weight] : weightsIn("relevant", relevant))
    o.weights.terms.push_back(
        tree_abstraction::relevant(name, weight, classesIn("relevant", name, classes)));
  for (const auto& [name, weight] : weightsIn("irrelevant", irrelevant))
    o.weights.terms.push_back(
        tree_abstraction::irrelevant(name, weight, classesIn("irrelevant", name, classes)));
  if (everything != 0)
    o.weights.terms.push_back(
        tree_abstraction::wholeClassVariable("everything", everything, classes.size()));
  o.weights.alpha = alpha;
  o.unknown = unknown;
  o.unknownWeight = unknownWeight;
  o.blockSize = blockSize;
  o.frame = frame;
  for (const std::string& text : split(regions, ';')) o.regions.push_back(regionIn(text));
  o.validate(classes.size());
  return o;
}

void TAbstractionOptions::validate() const {
  weightsIn("relevant", relevant);
  weightsIn("irrelevant", irrelevant);
  TAbstractionOptions noClasses = *this;
  noClasses.relevant = noClasses.irrelevant = "";
  noClasses.everything = 0;
  noClasses.forClasses(ClassTable());
}

}  // namespace semantic_map
