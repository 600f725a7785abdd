#include "WeightsFile.h"

#include <algorithm>
#include <map>

#include "SpaceOptions.h"

namespace semantic_map_compress {

using semantic_types::ClassTable;
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
  Reader(const std::filesystem::path& file, const ClassTable& classes)
      : m_yaml(file), m_classes(classes) {}

  WeightsFile read() const {
    const YAML::Node& root = m_yaml.root();
    m_yaml.checkMap(root);
    WeightsFile file;
    if (const YAML::Node list = root["solutions"]) {
      m_yaml.checkKeys(root, with(spaceKeys(), {"solutions"}));
      m_yaml.checkList(list, "solutions");
      for (const auto& entry : list) addSolution(entry, kSolutionKeys, file);
    } else {
      addSolution(root, with(spaceKeys(), kSolutionKeys), file);
    }
    file.space = readSpace(m_yaml);
    return file;
  }

 private:
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
    checkContradictions(node, solution);
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
    if (!value.IsMap())
      return tree_abstraction::relevant(name, m_yaml.notNegative(value, "weight of '" + name + "'"),
                                        {classId(key)});
    m_yaml.checkKeys(value, {"classes", "weight"});
    if (name == "everything" || name == kFreeSpace || m_classes.find(name))
      m_yaml.fail(key, "a group cannot be called '" + name + "'");
    const YAML::Node members = m_yaml.required(value, "classes");
    m_yaml.checkList(members, "classes of '" + name + "'");
    std::set<int> ids;
    for (const auto& member : members)
      if (!ids.insert(classId(member)).second)
        m_yaml.fail(member, "'" + member.Scalar() + "' twice in '" + name + "'");
    const double weight =
        m_yaml.notNegative(m_yaml.required(value, "weight"), "weight of '" + name + "'");
    return tree_abstraction::relevant(name, weight, {ids.begin(), ids.end()});
  }

  int classId(const YAML::Node& node) const {
    const std::string name = m_yaml.text(node, "a class");
    if (const auto id = m_classes.find(name)) return *id;
    if (name == kFreeSpace) return 0;
    std::string known = kFreeSpace;
    for (int id = 1; id <= m_classes.size(); ++id)
      known += ", " + m_classes.name(static_cast<semantic_types::ClassId>(id));
    m_yaml.fail(node, "the map has no class '" + name + "', only " + known);
  }

  /** Groups may bring a class in a second time. */
  void checkContradictions(const YAML::Node& node, const Solution& solution) const {
    std::map<int, const InformationTerm*> relevant;
    for (const InformationTerm& term : solution.terms)
      if (term.groups.size() == 1 && term.weight > 0)
        for (const int id : term.groups.front()) relevant[id] = &term;
    for (const InformationTerm& term : solution.terms) {
      if (term.groups.size() != 1 || !(term.weight < 0)) continue;
      for (const int id : term.groups.front())
        if (relevant.count(id))
          m_yaml.fail(node, "class '" + nameOf(id) + "' is both relevant ('" + relevant[id]->name +
                                "') and irrelevant ('" + term.name + "')");
    }
  }

  std::string nameOf(int id) const {
    return id == 0 ? kFreeSpace : m_classes.name(static_cast<semantic_types::ClassId>(id));
  }

  const StrictYaml m_yaml;
  const ClassTable& m_classes;
};

}  // namespace

WeightsFile loadWeights(const std::filesystem::path& file, const ClassTable& classes) {
  return Reader(file, classes).read();
}

}  // namespace semantic_map_compress
