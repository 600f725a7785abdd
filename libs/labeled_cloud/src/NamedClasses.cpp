#include "NamedClasses.h"

#include <map>

namespace labeled_cloud {

using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::kNoClass;

namespace {

ClassId classNamed(const strict_files::StrictYaml& yaml, const YAML::Node& node,
                   const ClassTable& table) {
  const std::string name = yaml.text(node, "a class");
  if (name == "no_class") return kNoClass;
  if (const auto id = table.find(name)) return *id;
  yaml.fail(node, "'" + name + "' is no class of the table; `fold` can say which it is");
}

}  // namespace

std::vector<ClassId> namedClasses(const strict_files::StrictYaml& yaml, const ClassTable& table) {
  std::map<std::string, ClassId> folds;
  if (const YAML::Node fold = yaml.root()["fold"]) {
    yaml.checkMap(fold);
    for (const auto& entry : fold)
      folds[entry.first.Scalar()] = classNamed(yaml, entry.second, table);
  }
  const YAML::Node names = yaml.required(yaml.root(), "classes");
  yaml.checkList(names, "classes");
  std::vector<ClassId> classes;
  for (const auto& name : names) {
    const auto folded = folds.find(yaml.text(name, "classes"));
    classes.push_back(folded == folds.end() ? classNamed(yaml, name, table) : folded->second);
  }
  return classes;
}

}  // namespace labeled_cloud
