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
#include <utility>
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

std::string nameOf(int id, const ClassTable& classes) {
  return id == 0 ? kFreeSpace : classes.name(static_cast<ClassId>(id));
}

/** The class with this name, 0 for free space. */
int idOf(const std::string& name, const ClassTable& classes) {
  if (const auto id = classes.find(name)) return *id;
  if (name == kFreeSpace) return 0;
  std::vector<std::string> known;
  for (int id = 0; id <= classes.size(); ++id) known.push_back(nameOf(id, classes));
  throw std::invalid_argument("unknown class '" + name + "'; known are " +
                              strict_files::joined(known) + strict_files::didYouMean(name, known));
}

/** Groups may bring a class in a second time, with the other sign. Terms of several groups are left
 * out: they tell classes apart and may well overlap with others.
 * \throw std::invalid_argument naming it. */
void checkSigns(const std::vector<InformationTerm>& terms, const ClassTable& classes) {
  std::map<int, std::string> relevant;
  for (const InformationTerm& term : terms)
    if (term.groups.size() == 1 && term.weight > 0)
      for (const int id : term.groups.front()) relevant[id] = term.name;
  for (const InformationTerm& term : terms) {
    if (term.groups.size() != 1 || !(term.weight < 0)) continue;
    for (const int id : term.groups.front())
      if (relevant.count(id))
        throw std::invalid_argument("class '" + nameOf(id, classes) + "' is both relevant ('" +
                                    relevant[id] + "') and irrelevant ('" + term.name + "')");
  }
}

InformationTerm everythingOf(double weight, const ClassTable& classes) {
  return tree_abstraction::wholeClassVariable("everything", weight, classes.size());
}

const std::set<std::string> kSolutionKeys = {"name", "relevant", "irrelevant", "everything",
                                             "alpha"};

std::set<std::string> with(std::set<std::string> keys, const std::set<std::string>& more) {
  keys.insert(more.begin(), more.end());
  return keys;
}

class Reader {
 public:
  Reader(StrictYaml yaml, const ClassTable& classes, double alpha)
      : m_yaml(std::move(yaml)), m_classes(classes) {
    m_ofAll.weights.alpha = alpha;
  }

  std::vector<AbstractionOptions> read() {
    const YAML::Node& root = m_yaml.root();
    m_yaml.checkMap(root);
    const std::set<std::string> keysOfAll = readOfAll(root);
    if (const YAML::Node list = root["solutions"]) {
      m_yaml.checkKeys(root, with(keysOfAll, {"solutions"}));
      m_yaml.checkList(list, "solutions");
      for (const auto& entry : list) addSolution(entry, kSolutionKeys);
    } else {
      addSolution(root, with(keysOfAll, kSolutionKeys));
    }
    return m_solutions;
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

  void addSolution(const YAML::Node& node, const std::set<std::string>& keys) {
    m_yaml.checkKeys(node, keys);
    const AbstractionOptions solution = readSolution(node);
    for (const AbstractionOptions& other : m_solutions)
      if (other.name == solution.name)
        m_yaml.fail(node["name"], "name: two solutions called '" + other.name + "'");
    m_solutions.push_back(solution);
  }

  AbstractionOptions readSolution(const YAML::Node& node) const {
    AbstractionOptions solution = m_ofAll;
    solution.name = readName(m_yaml.required(node, "name"));
    addTerms(node["relevant"], 1, solution);
    addTerms(node["irrelevant"], -1, solution);
    std::vector<InformationTerm>& terms = solution.weights.terms;
    if (const YAML::Node weight = node["everything"])
      terms.push_back(everythingOf(m_yaml.notNegative(weight, "everything"), m_classes));
    at(node, [&] { checkSigns(terms, m_classes); });
    if (terms.empty())
      m_yaml.fail(node, "solution '" + solution.name +
                            "' weighs nothing: expected relevant, irrelevant or everything");
    if (const YAML::Node alpha = node["alpha"])
      solution.weights.alpha = m_yaml.notNegative(alpha, "alpha");
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

  void addTerms(const YAML::Node& node, double sign, AbstractionOptions& solution) const {
    if (!node) return;
    m_yaml.checkMap(node);
    for (const auto& entry : node) addTerm(entry.first, entry.second, sign, solution);
  }

  /** `class: weight` or `group: {classes: [...], weight: ...}` */
  void addTerm(const YAML::Node& key, const YAML::Node& value, double sign,
               AbstractionOptions& solution) const {
    const std::string name = key.Scalar(), what = "weight of '" + name + "'";
    if (!value.IsMap()) {
      const double weight = m_yaml.notNegative(value, what);
      return at(key, [&] { solution.add(m_classes, name, {name}, sign * weight); });
    }
    m_yaml.checkKeys(value, {"classes", "weight"});
    if (name == "everything" || name == kFreeSpace || m_classes.find(name))
      m_yaml.fail(key, "a group cannot be called '" + name + "'");
    const YAML::Node list = m_yaml.required(value, "classes");
    m_yaml.checkList(list, "classes of '" + name + "'");
    std::vector<std::string> members;
    for (const auto& member : list) members.push_back(m_yaml.text(member, "a class"));
    const double weight = m_yaml.notNegative(m_yaml.required(value, "weight"), what);
    at(list, [&] { solution.add(m_classes, name, members, sign * weight); });
  }

  /** What the file says of all solutions. \return the keys about it */
  std::set<std::string> readOfAll(const YAML::Node& root) {
    OptionList list;
    m_ofAll.describe(list);
    for (const char* other : {"relevant", "irrelevant", "everything", "alpha", "regions"})
      list.remove(other);
    m_yaml.read(root, list);
    if (const YAML::Node regions = root["regions"]) {
      m_yaml.checkList(regions, "regions");
      for (const auto& region : regions)
        m_ofAll.regions.push_back(
            at(region, [&] { return Region::ofText(m_yaml.text(region, "a region")); }));
    }
    const std::vector<std::string> names = list.names();
    return with({"regions"}, {names.begin(), names.end()});
  }

  const StrictYaml m_yaml;
  const ClassTable& m_classes;
  AbstractionOptions m_ofAll;
  std::vector<AbstractionOptions> m_solutions;
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

std::vector<AbstractionOptions> loadWeights(const std::filesystem::path& file,
                                            const ClassTable& classes, double alpha) {
  return Reader(StrictYaml(file), classes, alpha).read();
}

std::vector<AbstractionOptions> weightsOfText(const std::string& text, const std::string& name,
                                              const ClassTable& classes, double alpha) {
  return Reader(StrictYaml(text, name), classes, alpha).read();
}

AbstractionOptions solutionIn(const std::vector<AbstractionOptions>& solutions,
                              const std::string& wanted, const std::string& source) {
  std::vector<std::string> names;
  for (const AbstractionOptions& s : solutions) {
    if (wanted.empty() || s.name == wanted) return s;
    names.push_back(s.name);
  }
  throw std::runtime_error(source + ": " + strict_files::unknownWord("solution", wanted, names));
}

void AbstractionOptions::describe(OptionList& list) {
  using strict_files::atLeast;
  list.add(
      "relevant", relevant, "",
      "classes worth keeping and their weights, \"road: 1, car+truck: 0.5\"; those joined by + "
      "count as one. Without any weights no abstraction is kept");
  list.add("irrelevant", irrelevant, "", "classes worth dropping, written likewise");
  list.add("everything", everything, "", "weight of telling all classes apart");
  list.add("alpha", weights.alpha, "", atLeast(0), "price of detail, per nat");
  list.add(
      "block_size", blockSize, "m", atLeast(0),
      "edge of the blocks inside which unknown space counts, the coarsest cells; 0: no blocks");
  list.add("unknown", unknown, "",
           "what unknown space is taken for: a value of its own, or all classes alike");
  list.add(
      "regions", regionTexts, "",
      "parts of space of another weight than 1, m: \"box x0 y0 z0 x1 y1 z1 weight; sphere x y z "
      "radius weight; corridor x0 y0 z0 x1 y1 z1 radius weight\"");
}

bool AbstractionOptions::isSet() const {
  return !relevant.empty() || !irrelevant.empty() || everything != 0 || !weights.terms.empty();
}

void AbstractionOptions::add(const ClassTable& classes, const std::string& term,
                             const std::vector<std::string>& members, double weight) {
  std::set<int> ids;
  for (const std::string& member : members)
    if (!ids.insert(idOf(member, classes)).second)
      throw std::invalid_argument("'" + member + "' twice in '" + term + "'");
  for (const InformationTerm& other : weights.terms)
    if (other.name == term)
      throw std::invalid_argument(
          "'" + term + "' " +
          (other.weight * weight < 0 ? "is both relevant and irrelevant" : "twice"));
  weights.terms.push_back({term, weight, {{ids.begin(), ids.end()}}});
}

AbstractionOptions AbstractionOptions::forClasses(const ClassTable& classes) const {
  validate();
  AbstractionOptions o = *this;
  const auto take = [&](const std::string& option, std::string& text, double sign) {
    for (const auto& entry : numbersIn(option, std::exchange(text, "")))
      named(option,
            [&] { o.add(classes, entry.first, split(entry.first, '+'), sign * entry.second); });
  };
  o.weights.terms.clear();
  take("relevant", o.relevant, 1);
  take("irrelevant", o.irrelevant, -1);
  if (everything != 0) o.weights.terms.push_back(everythingOf(everything, classes));
  o.everything = 0;
  for (const InformationTerm& term : weights.terms) o.weights.terms.push_back(term);
  o.weights.validate(classes.size());
  checkSigns(o.weights.terms, classes);
  for (const std::string& text : split(std::exchange(o.regionTexts, ""), ';'))
    o.regions.push_back(Region::ofText(text));
  return o;
}

void AbstractionOptions::validate() const {
  strict_files::checkOptions(*this, "AbstractionOptions");
  numbersIn("relevant", relevant);
  numbersIn("irrelevant", irrelevant);
  for (const Region& region : regions) region.validate();
  for (const std::string& text : split(regionTexts, ';'))
    named("regions", [&] { return Region::ofText(text); });
}

}  // namespace semantic_octree
