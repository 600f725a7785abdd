#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_types/ClassTable.h>
#include <strict_files/StrictYaml.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace semantic_octree {

using semantic_types::ClassId;
using semantic_types::ClassTable;
using strict_files::numberOf;
using strict_files::OptionList;
using strict_files::StrictYaml;
using strict_files::trimmed;
using tree_abstraction::InformationTerm;
using NamedNumbers = std::vector<std::pair<std::string, double>>;

namespace {

/** The terms of a solution by the names of classes, for every form in which weights are written.
 * All functions throw std::invalid_argument saying what is wrong. */
class TermList {
 public:
  explicit TermList(const ClassTable& classes) : m_classes(classes) {}

  /** Several members count as one. \param weight below 0 where they are irrelevant */
  void add(const std::string& name, const std::vector<std::string>& members, double weight) {
    std::set<int> ids;
    for (const std::string& member : members)
      if (!ids.insert(idOf(member)).second)
        throw std::invalid_argument("'" + member + "' twice in '" + name + "'");
    for (const InformationTerm& other : m_terms)
      if (other.name == name)
        throw std::invalid_argument(
            "'" + name + "' " +
            (other.weight * weight < 0 ? "is both relevant and irrelevant" : "twice"));
    m_terms.push_back({name, weight, {{ids.begin(), ids.end()}}});
  }
  void addEverything(double weight) {
    m_terms.push_back(tree_abstraction::wholeClassVariable("everything", weight, m_classes.size()));
  }
  /** All of them. Groups may bring a class in a second time, with the other sign. */
  std::vector<InformationTerm> checked() const {
    std::map<int, std::string> relevant;
    for (const InformationTerm& term : m_terms)
      if (term.groups.size() == 1 && term.weight > 0)
        for (const int id : term.groups.front()) relevant[id] = term.name;
    for (const InformationTerm& term : m_terms) {
      if (term.groups.size() != 1 || !(term.weight < 0)) continue;
      for (const int id : term.groups.front())
        if (relevant.count(id))
          throw std::invalid_argument("class '" + nameOf(id) + "' is both relevant ('" +
                                      relevant[id] + "') and irrelevant ('" + term.name + "')");
    }
    return m_terms;
  }

 private:
  /** The class with this name, 0 for free space. */
  int idOf(const std::string& name) const {
    if (const auto id = m_classes.find(name)) return *id;
    if (name == kFreeSpace) return 0;
    std::vector<std::string> known;
    for (int id = 0; id <= m_classes.size(); ++id) known.push_back(nameOf(id));
    throw std::invalid_argument("unknown class '" + name + "'; known are " +
                                strict_files::joined(known) +
                                strict_files::didYouMean(name, known));
  }
  std::string nameOf(int id) const {
    return id == 0 ? kFreeSpace : m_classes.name(static_cast<ClassId>(id));
  }

  const ClassTable& m_classes;
  std::vector<InformationTerm> m_terms;
};

const std::set<std::string> kSolutionKeys = {"name", "relevant", "irrelevant", "everything",
                                             "alpha"};

std::set<std::string> with(std::set<std::string> keys, const std::set<std::string>& more) {
  keys.insert(more.begin(), more.end());
  return keys;
}

class Reader {
 public:
  Reader(StrictYaml yaml, const ClassTable& classes)
      : m_yaml(std::move(yaml)), m_classes(classes) {}

  WeightsFile read(const std::string& name) const {
    const YAML::Node& root = m_yaml.root();
    m_yaml.checkMap(root);
    WeightsFile file;
    file.name = name;
    const std::set<std::string> spaceKeys = readSpace(root, file.space);
    if (const YAML::Node list = root["solutions"]) {
      m_yaml.checkKeys(root, with(spaceKeys, {"solutions"}));
      m_yaml.checkList(list, "solutions");
      for (const auto& entry : list) addSolution(entry, kSolutionKeys, file);
    } else {
      addSolution(root, with(spaceKeys, kSolutionKeys), file);
    }
    return file;
  }

 private:
  /** Runs an action, whose complaints are about a place in the file. */
  template <typename Action>
  auto at(const YAML::Node& where, Action action) const -> decltype(action()) {
    try {
      return action();
    } catch (const std::invalid_argument& e) {
      m_yaml.fail(where, e.what());
    }
  }

  void addSolution(const YAML::Node& node, const std::set<std::string>& keys,
                   WeightsFile& file) const {
    m_yaml.checkKeys(node, keys);
    Solution solution = readSolution(node);
    for (const Solution& other : file.solutions)
      if (other.name == solution.name)
        m_yaml.fail(node["name"], "name: two solutions called '" + other.name + "'");
    file.solutions.push_back(std::move(solution));
  }

  Solution readSolution(const YAML::Node& node) const {
    Solution solution;
    solution.name = readName(m_yaml.required(node, "name"));
    TermList terms(m_classes);
    addTerms(node["relevant"], 1, terms);
    addTerms(node["irrelevant"], -1, terms);
    if (const YAML::Node weight = node["everything"])
      terms.addEverything(m_yaml.notNegative(weight, "everything"));
    solution.terms = at(node, [&] { return terms.checked(); });
    if (solution.terms.empty())
      m_yaml.fail(node, "solution '" + solution.name +
                            "' weighs nothing: expected relevant, irrelevant or everything");
    if (const YAML::Node alpha = node["alpha"]) solution.alpha = m_yaml.notNegative(alpha, "alpha");
    return solution;
  }

  std::string readName(const YAML::Node& node) const {
    std::string name = m_yaml.text(node, "name");
    const bool fine = !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
      return std::isalnum(c) || c == '-' || c == '_';
    });
    if (!fine)
      m_yaml.fail(node, "name: expected letters, digits, '-' and '_', found '" + name + "'");
    return name;
  }

  void addTerms(const YAML::Node& node, double sign, TermList& terms) const {
    if (!node) return;
    m_yaml.checkMap(node);
    for (const auto& entry : node) addTerm(entry.first, entry.second, sign, terms);
  }

  /** `class: weight` or `group: {classes: [...], weight: ...}` */
  void addTerm(const YAML::Node& key, const YAML::Node& value, double sign, TermList& terms) const {
    const std::string name = key.Scalar(), what = "weight of '" + name + "'";
    if (!value.IsMap()) {
      const double weight = m_yaml.notNegative(value, what);
      return at(key, [&] { terms.add(name, {name}, sign * weight); });
    }
    m_yaml.checkKeys(value, {"classes", "weight"});
    if (name == "everything" || name == kFreeSpace || m_classes.find(name))
      m_yaml.fail(key, "a group cannot be called '" + name + "'");
    const YAML::Node list = m_yaml.required(value, "classes");
    m_yaml.checkList(list, "classes of '" + name + "'");
    std::vector<std::string> members;
    for (const auto& member : list) members.push_back(m_yaml.text(member, "a class"));
    const double weight = m_yaml.notNegative(m_yaml.required(value, "weight"), what);
    at(list, [&] { terms.add(name, members, sign * weight); });
  }

  /** \return the keys about it */
  std::set<std::string> readSpace(const YAML::Node& root, AbstractionOptions& space) const {
    OptionList list;
    space.describe(list);
    m_yaml.read(root, list);
    std::set<std::string> keys = {"regions"};
    for (const std::string& name : list.names()) keys.insert(name);
    if (const YAML::Node regions = root["regions"]) {
      m_yaml.checkList(regions, "regions");
      for (const auto& region : regions)
        space.regions.push_back(
            at(region, [&] { return Region::ofText(m_yaml.text(region, "a region")); }));
    }
    return keys;
  }

  const StrictYaml m_yaml;
  const ClassTable& m_classes;
};

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

const Solution& WeightsFile::solution(const std::string& wanted) const {
  std::vector<std::string> names;
  for (const Solution& s : solutions) {
    if (wanted.empty() || s.name == wanted) return s;
    names.push_back(s.name);
  }
  throw std::runtime_error(name + ": " + strict_files::unknownWord("solution", wanted, names));
}

WeightsFile loadWeights(const std::filesystem::path& file, const ClassTable& classes) {
  return Reader(StrictYaml(file), classes).read(file.string());
}

WeightsFile weightsOfText(const std::string& text, const std::string& name,
                          const ClassTable& classes) {
  return Reader(StrictYaml(text, name), classes).read(name);
}

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
  TermList terms(classes);
  const auto add = [&](const std::string& option, const std::string& text, double sign) {
    for (const auto& [name, weight] : numbersIn(option, text))
      named(option, [&, &name = name, &weight = weight] {
        terms.add(name, split(name, '+'), sign * weight);
      });
  };
  add("relevant", relevant, 1);
  add("irrelevant", irrelevant, -1);
  if (everything != 0) terms.addEverything(everything);
  o.weights.terms = terms.checked();
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
