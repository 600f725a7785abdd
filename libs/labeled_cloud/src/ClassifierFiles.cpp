#include <labeled_cloud/LabelModel.h>
#include <labeled_cloud/NetworkLabeler.h>
#include <semantic_types/ClassTable.h>
#include <strict_files/StrictYaml.h>

#include <map>
#include <stdexcept>
#include <vector>

namespace labeled_cloud {

using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::kNoClass;
using strict_files::atLeast;
using strict_files::OptionList;
using strict_files::require;

namespace {

ClassId classNamed(const strict_files::StrictYaml& yaml, const YAML::Node& node,
                   const ClassTable& table) {
  const std::string name = yaml.text(node, "a class");
  if (name == "no_class") return kNoClass;
  if (const auto id = table.find(name)) return *id;
  yaml.fail(node, "'" + name + "' is no class of the table; `fold` can say which it is");
}

/** A classifier's classes in its own order, as ids of the table. `classes` lists their names;
 * `fold` gives the table's name (or `no_class`) for those that the table calls otherwise.
 * \throw std::runtime_error naming file, line and a name that is not in the table. */
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

/** Reads a map whose keys are the options of a list. */
void readAll(const strict_files::StrictYaml& yaml, const YAML::Node& node,
             const strict_files::OptionList& list) {
  const std::vector<std::string> names = list.names();
  yaml.checkKeys(node, {names.begin(), names.end()});
  yaml.read(node, list);
}

void addRow(const strict_files::StrictYaml& yaml, const YAML::Node& row,
            const std::vector<ClassId>& classes, std::vector<double>& counts) {
  yaml.checkList(row, "confusion");
  if (row.size() != classes.size())
    yaml.fail(row, "confusion: a row of " + std::to_string(row.size()) + " counts for " +
                       std::to_string(classes.size()) + " classes");
  for (std::size_t c = 0; c < classes.size(); ++c) {
    const double count = yaml.notNegative(row[c], "confusion");
    if (classes[c] != kNoClass) counts[classes[c] - 1] += count;
  }
}

}  // namespace

void NetworkOptions::describeInput(OptionList& list) {
  list.add("width", width, "pixels", atLeast(1), "width of the input; must be given");
  list.add("height", height, "pixels", atLeast(1), "height of the input; must be given");
  list.add("fit", fit, "",
           "stretch: to the input's size; width: scaled to its width, top rows are cut off, or the "
           "last row is repeated below");
  list.add("channels", channels, "", "their order");
  list.add("mean", mean, "", "each channel is (value - mean) / std, its value from 0 to 1");
  list.add("std", deviation, "", "standard deviation of each channel, above 0");
}

void NetworkOptions::describeOutput(OptionList& list) {
  list.add("name", output, "", "name of the layer; may be left out if there is only one");
  list.add("content", content, "",
           "a plane of scores or of probabilities for each class, or one of numbers of `classes` "
           "from 0");
}

void NetworkOptions::validate() const {
  NetworkOptions copy = *this;
  OptionList inputs, outputs;
  copy.describeInput(inputs);
  copy.describeOutput(outputs);
  for (const OptionList* list : {&inputs, &outputs}) checkAll(*list, "NetworkOptions");
  for (const double d : deviation) require(d > 0, "NetworkOptions::std", d, "a number above 0");
  require(!classes.empty(), "number of classes", 0, "1 or more");
}

NetworkOptions loadNetworkOptions(const std::filesystem::path& file, const ClassTable& table) {
  const strict_files::StrictYaml yaml(file);
  yaml.checkKeys(yaml.root(), {"input", "output", "classes", "fold"});
  NetworkOptions options;
  OptionList inputs, outputs;
  options.describeInput(inputs);
  options.describeOutput(outputs);
  const YAML::Node input = yaml.required(yaml.root(), "input");
  readAll(yaml, input, inputs);
  for (const char* key : {"width", "height"}) yaml.required(input, key);
  if (const YAML::Node output = yaml.root()["output"]) readAll(yaml, output, outputs);
  options.classes = namedClasses(yaml, table);
  try {
    options.validate();
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(file.string() + ": " + e.what());
  }
  return options;
}

ConfusionMatrix loadConfusionMatrix(const std::filesystem::path& file, const ClassTable& table) {
  const strict_files::StrictYaml yaml(file);
  yaml.checkMap(yaml.root());
  const auto classes = namedClasses(yaml, table);
  const YAML::Node rows = yaml.required(yaml.root(), "confusion");
  if (!rows.IsSequence() || rows.size() != classes.size())
    yaml.fail(rows, "confusion: expected a row for each of " + std::to_string(classes.size()) +
                        " classes");
  std::vector<std::vector<double>> counts(table.size(), std::vector<double>(table.size(), 0.0));
  for (std::size_t k = 0; k < classes.size(); ++k)
    if (classes[k] != kNoClass) addRow(yaml, rows[k], classes, counts[classes[k] - 1]);
  try {
    return ConfusionMatrix(counts);
  } catch (const std::invalid_argument& e) {
    yaml.fail(rows, e.what());
  }
}

}  // namespace labeled_cloud
