#include <labeled_cloud/LabelModel.h>
#include <strict_files/StrictYaml.h>

#include <stdexcept>

#include "NamedClasses.h"

namespace labeled_cloud {

using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::kNoClass;

namespace {

using Counts = std::vector<std::vector<double>>;

/** Adds the counts of one true class. */
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

ConfusionMatrix loadConfusionMatrix(const std::filesystem::path& file, const ClassTable& table) {
  const strict_files::StrictYaml yaml(file);
  yaml.checkMap(yaml.root());
  const auto classes = namedClasses(yaml, table);
  const YAML::Node rows = yaml.required(yaml.root(), "confusion");
  if (!rows.IsSequence() || rows.size() != classes.size())
    yaml.fail(rows, "confusion: expected a row for each of " + std::to_string(classes.size()) +
                        " classes");
  Counts counts(table.size(), std::vector<double>(table.size(), 0.0));
  for (std::size_t k = 0; k < classes.size(); ++k)
    if (classes[k] != kNoClass) addRow(yaml, rows[k], classes, counts[classes[k] - 1]);
  try {
    return ConfusionMatrix(counts);
  } catch (const std::invalid_argument& e) {
    yaml.fail(rows, e.what());
  }
}

}  // namespace labeled_cloud
