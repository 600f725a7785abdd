#include <labeled_cloud/ScanConverter.h>

#include <stdexcept>

#include "PointGrid.h"

namespace labeled_cloud {

using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::kNoClass;

namespace {

/** Class of the table for each class of an observation. */
class ClassTranslation {
 public:
  ClassTranslation(const ClassTable& table, const std::vector<std::string>& names)
      : m_table(table), m_names(names) {}

  /** \throw std::invalid_argument the table lacks the class, and takes that for an error. */
  ClassId operator()(ClassId id) {
    if (id == kNoClass) return kNoClass;
    auto& known = m_known[id];
    if (!known) known = lookUp(id);
    return *known;
  }

 private:
  ClassId lookUp(ClassId id) const {
    const bool named = !m_names.empty();
    if (named && id > m_names.size())
      throw std::invalid_argument("its class " + std::to_string(id) + " has no name");
    if (!named && m_table.contains(id)) return id;
    if (named)
      if (const auto found = m_table.find(m_names[id - 1])) return *found;
    if (m_table.unknownRawId() == ClassTable::UnknownRawId::NoClass) return kNoClass;
    throw std::invalid_argument(named ? "its class '" + m_names[id - 1] + "' is not in the table"
                                      : "its class " + std::to_string(id) + " is not one of 1.." +
                                            std::to_string(m_table.size()));
  }

  const ClassTable& m_table;
  const std::vector<std::string>& m_names;
  std::optional<ClassId> m_known[256];
};

/** Appends one point's class probabilities in the order of the table. */
void appendTranslated(const float* from, std::size_t classes, ClassTranslation& translate,
                      std::size_t tableSize, std::vector<float>& to) {
  const std::size_t row = to.size();
  to.resize(row + tableSize, 0.f);
  for (std::size_t k = 0; k < classes; ++k) {
    const ClassId id = from[k] > 0 ? translate(static_cast<ClassId>(k + 1)) : kNoClass;
    if (id != kNoClass) to[row + id - 1] += from[k];
  }
}

}  // namespace

void ScanConverter::addNamedCloud(NamedCloud named, LabeledScan& scan) const {
  const auto& from = named.cloud;
  auto& to = scan.cloud;
  ClassTranslation translate(m_table, named.classNames);
  const std::size_t classes = from.empty() ? 0 : from.probabilities.size() / from.size();
  if (!named.classNames.empty() && classes > named.classNames.size())
    throw std::invalid_argument("probabilities of " + std::to_string(classes) +
                                " classes, but names of " +
                                std::to_string(named.classNames.size()));
  to.points.reserve(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (!PointGrid::isReturn(from.points[i])) continue;
    to.points.push_back(from.points[i]);
    if (!from.classes.empty()) to.classes.push_back(translate(from.classes.at(i)));
    if (classes > 0)
      appendTranslated(&from.probabilities[i * classes], classes, translate, m_table.size(),
                       to.probabilities);
  }
  scan.counts.invalid = from.size() - to.size();
  if (!from.classes.empty() || classes > 0) m_options.labels.apply(m_table.size(), {}, to);
}

}  // namespace labeled_cloud
