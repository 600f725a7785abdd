#include <semantic_abstraction/AbstractionOptions.h>

#include <strict_files/TextFile.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace semantic_octree {

using strict_files::Choices;
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

const Choices<AbstractionOptions::Unknown>& choicesOf(AbstractionOptions::Unknown) {
  using Unknown = AbstractionOptions::Unknown;
  static const Choices<Unknown> choices = {{"own_class", Unknown::OwnClass},
                                           {"uniform", Unknown::Uniform}};
  return choices;
}

using tree_abstraction::InformationTerm;

TermCatalog::TermCatalog(const semantic_types::ClassTable& classes,
                         const std::vector<AbstractionOptions>& solutions)
    : m_numClasses(static_cast<std::size_t>(classes.size())) {
  add({kFreeSpace, 0, {{0}}});
  for (int id = 1; id <= classes.size(); ++id)
    add({classes.name(static_cast<semantic_types::ClassId>(id)), 0, {{id}}});
  for (const AbstractionOptions& solution : solutions)
    for (const InformationTerm& term : solution.weights.terms)
      if (indexOf(term) == size()) add(term);
  std::vector<bool> isWeighed(size(), false);
  for (const AbstractionOptions& solution : solutions)
    for (const InformationTerm& term : solution.weights.terms) isWeighed[indexOf(term)] = true;
  for (std::size_t t = 0; t < size(); ++t) m_order.push_back(t);
  std::stable_partition(m_order.begin(), m_order.end(),
                        [&](std::size_t t) { return isWeighed[t]; });
}

std::size_t TermCatalog::indexOf(const InformationTerm& term) const {
  const auto same = [&](const InformationTerm& t) { return t.groups == term.groups; };
  return static_cast<std::size_t>(std::find_if(m_terms.begin(), m_terms.end(), same) -
                                  m_terms.begin());
}

/** Solutions may mean different groups by one name. */
void TermCatalog::add(InformationTerm term) {
  const std::string name = term.name;
  const auto isTaken = [&](const InformationTerm& t) { return t.name == term.name; };
  for (int n = 2; std::any_of(m_terms.begin(), m_terms.end(), isTaken); ++n)
    term.name = name + " (" + std::to_string(n) + ")";
  term.weight = 0;
  m_terms.push_back(std::move(term));
}

std::vector<InformationTerm> TermCatalog::terms(const AbstractionOptions& solution) const {
  const std::vector<double> weights = this->weights(solution);
  std::vector<InformationTerm> terms;
  for (std::size_t i = 0; i < size(); ++i) {
    terms.push_back(m_terms[m_order[i]]);
    terms.back().weight = weights[i];
  }
  return terms;
}

std::vector<double> TermCatalog::weights(const AbstractionOptions& solution) const {
  std::vector<double> all(size(), 0.0), weights;
  for (const InformationTerm& term : solution.weights.terms) all[indexOf(term)] += term.weight;
  for (const std::size_t t : m_order) weights.push_back(all[t]);
  return weights;
}

}  // namespace semantic_octree
