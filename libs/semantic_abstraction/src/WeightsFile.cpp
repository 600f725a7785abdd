#include <semantic_abstraction/AbstractionOptions.h>
#include <strict_files/StrictYaml.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <cctype>

#include "TermsByName.h"

namespace semantic_octree {

using semantic_types::ClassTable;
using strict_files::OptionList;
using strict_files::StrictYaml;
using tree_abstraction::InformationTerm;

namespace {

const std::set<std::string> kSolutionKeys = {"name", "relevant", "irrelevant", "everything",
                                             "alpha"};

std::set<std::string> with(std::set<std::string> keys, const std::set<std::string>& more) {
  keys.insert(more.begin(), more.end());
  return keys;
}

class Reader {
 public:
  Reader(StrictYaml yaml, const ClassTable& classes)
      : m_yaml(std::move(yaml)), m_classes(classes), m_terms(classes) {}

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
    addTerms(node["relevant"], 1, solution.terms);
    addTerms(node["irrelevant"], -1, solution.terms);
    if (const YAML::Node weight = node["everything"])
      solution.terms.push_back(tree_abstraction::wholeClassVariable(
          "everything", m_yaml.notNegative(weight, "everything"), m_classes.size()));
    if (solution.terms.empty())
      m_yaml.fail(node, "solution '" + solution.name +
                            "' weighs nothing: expected relevant, irrelevant or everything");
    at(node, [&] { m_terms.checkContradictions(solution.terms); });
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

  void addTerms(const YAML::Node& node, double sign, std::vector<InformationTerm>& terms) const {
    if (!node) return;
    m_yaml.checkMap(node);
    for (const auto& entry : node) {
      InformationTerm term = readTerm(entry.first.Scalar(), entry.first, entry.second);
      term.weight *= sign;
      for (const InformationTerm& other : terms)
        if (other.name == term.name)
          m_yaml.fail(entry.first, "'" + term.name + "' is both relevant and irrelevant");
      terms.push_back(std::move(term));
    }
  }

  /** `class: weight` or `group: {classes: [...], weight: ...}` */
  InformationTerm readTerm(const std::string& name, const YAML::Node& key,
                           const YAML::Node& value) const {
    const std::string what = "weight of '" + name + "'";
    if (!value.IsMap()) {
      const double weight = m_yaml.notNegative(value, what);
      return at(key, [&] { return m_terms.term(name, {name}, weight); });
    }
    m_yaml.checkKeys(value, {"classes", "weight"});
    if (name == "everything" || name == kFreeSpace || m_classes.find(name))
      m_yaml.fail(key, "a group cannot be called '" + name + "'");
    const YAML::Node list = m_yaml.required(value, "classes");
    m_yaml.checkList(list, "classes of '" + name + "'");
    std::vector<std::string> members;
    for (const auto& member : list) members.push_back(m_yaml.text(member, "a class"));
    const double weight = m_yaml.notNegative(m_yaml.required(value, "weight"), what);
    return at(list, [&] { return m_terms.term(name, members, weight); });
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
  const TermsByName m_terms;
};

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

}  // namespace semantic_octree
