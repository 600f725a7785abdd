#include <semantic_abstraction/AbstractionOptions.h>
#include <strict_files/Words.h>

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "TermsByName.h"

namespace semantic_octree {

using semantic_types::ClassTable;
using strict_files::numberOf;
using strict_files::trimmed;
using NamedNumbers = std::vector<std::pair<std::string, double>>;

namespace {

/** The parts of a text between separators, without the spaces around them; no empty ones. */
std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);)
    if (part = trimmed(part); !part.empty()) parts.push_back(part);
  return parts;
}

[[noreturn]] void refuse(const std::string& option, const std::string& value,
                         const std::string& expected) {
  throw std::invalid_argument(option + ": '" + value + "', expected " + expected);
}

/** Says which option it is that something is wrong with. */
template <typename Action>
auto named(const std::string& option, Action action) -> decltype(action()) {
  try {
    return action();
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(option + ": " + e.what());
  }
}

/** "road: 1, car+truck: 0.5" */
NamedNumbers numbersIn(const std::string& option, const std::string& text) {
  NamedNumbers numbers;
  for (const std::string& entry : split(text, ',')) {
    const std::size_t colon = entry.rfind(':');
    if (colon == std::string::npos) refuse(option, entry, "a class and a number, \"road: 1\"");
    const std::string expected = "a number of 0 or more behind the colon";
    double number = -1;
    try {
      number = numberOf(trimmed(entry.substr(colon + 1)));
    } catch (const std::invalid_argument&) {
      refuse(option, entry, expected);
    }
    if (!(number >= 0) || std::isinf(number)) refuse(option, entry, expected);
    numbers.emplace_back(trimmed(entry.substr(0, colon)), number);
  }
  return numbers;
}

}  // namespace

void AbstractionText::describe(strict_files::OptionList& list) {
  list.add(
      "relevant", relevant, "",
      "classes worth keeping and their weights, \"road: 1, car+truck: 0.5\"; those joined by + "
      "count as one. Without any weights no abstraction is kept");
  list.add("irrelevant", irrelevant, "", "classes worth dropping, written likewise");
  list.add("everything", everything, "", "weight of telling all classes apart");
  list.add("alpha", alpha, "", strict_files::atLeast(0), "price of detail, per nat");
  AbstractionSpace::describe(list);
  list.add(
      "regions", regions, "",
      "parts of space of another weight than 1, m: \"box x0 y0 z0 x1 y1 z1 weight; sphere x y z "
      "radius weight; corridor x0 y0 z0 x1 y1 z1 radius weight\"");
}

AbstractionOptions AbstractionText::forClasses(const ClassTable& classes) const {
  AbstractionOptions o;
  static_cast<AbstractionSpace&>(o) = *this;
  const TermsByName terms(classes);
  const auto add = [&](const std::string& option, const std::string& text, double sign) {
    for (const auto& [name, weight] : numbersIn(option, text))
      o.weights.terms.push_back(named(option, [&, &name = name, &weight = weight] {
        return terms.term(name, split(name, '+'), sign * weight);
      }));
  };
  add("relevant", relevant, 1);
  add("irrelevant", irrelevant, -1);
  terms.checkContradictions(o.weights.terms);
  if (everything != 0)
    o.weights.terms.push_back(
        tree_abstraction::wholeClassVariable("everything", everything, classes.size()));
  o.weights.alpha = alpha;
  for (const std::string& text : split(regions, ';'))
    o.regions.push_back(named("regions", [&] { return Region::ofText(text); }));
  o.validate(classes.size());
  return o;
}

void AbstractionText::validate() const {
  strict_files::checkOptions(*this, "AbstractionOptions");
  numbersIn("relevant", relevant);
  numbersIn("irrelevant", irrelevant);
  for (const std::string& text : split(regions, ';'))
    named("regions", [&] { return Region::ofText(text); });
}

}  // namespace semantic_octree
