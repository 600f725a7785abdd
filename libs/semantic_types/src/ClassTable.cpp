#include <semantic_types/ClassTable.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <stdexcept>

namespace semantic_types {

ClassId ClassTable::add(const std::string& name, Color color) {
  if (name.empty()) throw std::invalid_argument("class table: a class without a name");
  if (const std::string shown = strict_files::printable(name); shown != name)
    throw std::invalid_argument("class table: the name of class " + std::to_string(size() + 1) +
                                ", '" + shown + "', has control characters or is not UTF-8");
  if (m_ids.count(name))
    throw std::invalid_argument("class table: two classes named '" + name + "'");
  if (size() == kMaxClasses)
    throw std::invalid_argument("class table: more than " + std::to_string(kMaxClasses) +
                                " classes");
  m_entries.push_back({name, color});
  return m_ids[name] = static_cast<ClassId>(size());
}

const ClassTable::Entry& ClassTable::entry(ClassId id) const {
  static const Entry noClass{"no class", {150, 150, 150}};
  if (id == kNoClass) return noClass;
  if (!contains(id))
    throw std::out_of_range("class table: class " + std::to_string(id) + " is not one of 1.." +
                            std::to_string(size()));
  return m_entries[id - 1];
}

std::optional<ClassId> ClassTable::find(const std::string& name) const {
  const auto it = m_ids.find(name);
  if (it == m_ids.end()) return std::nullopt;
  return it->second;
}

std::optional<ClassId> ClassTable::find(Color color) const {
  for (int i = 0; i < size(); ++i)
    if (m_entries[i].color == color) return static_cast<ClassId>(i + 1);
  return std::nullopt;
}

void ClassTable::setHalfLife(ClassId id, double seconds) {
  const Entry& known = entry(id);
  if (seconds != kForever && !(seconds >= 0.001 && seconds <= 1e9))
    throw std::invalid_argument("class table: half-life of " +
                                (id == kNoClass ? "free space" : "'" + known.name + "'") + " = " +
                                std::to_string(seconds) + " s, expected 0.001 to 1000000000");
  (id == kNoClass ? m_freeHalfLife : m_entries[id - 1].halfLife) = seconds;
}

bool ClassTable::hasHalfLives() const {
  return m_freeHalfLife != kForever ||
         std::any_of(m_entries.begin(), m_entries.end(),
                     [](const Entry& e) { return e.halfLife != kForever; });
}

void ClassTable::fold(std::uint32_t rawId, ClassId id) {
  if (id != kNoClass && !contains(id))
    throw std::invalid_argument("class table: raw id " + std::to_string(rawId) +
                                " folds to class " + std::to_string(id) +
                                ", which is not one of 1.." + std::to_string(size()));
  if (!m_folds.emplace(rawId, id).second)
    throw std::invalid_argument("class table: raw id " + std::to_string(rawId) + " folds twice");
  if (id != kNoClass) m_hasOwnRawIds = false;
}

ClassId ClassTable::fromRaw(std::uint32_t rawId) const {
  const auto it = m_folds.find(rawId);
  if (it != m_folds.end()) return it->second;
  if (m_hasOwnRawIds && rawId >= 1 && rawId <= static_cast<std::uint32_t>(size()))
    return static_cast<ClassId>(rawId);
  if (m_unknownRawId == UnknownRawId::NoClass) return kNoClass;
  throw std::invalid_argument("raw class id " + std::to_string(rawId) +
                              " is not in the class table");
}

bool ClassTable::operator==(const ClassTable& o) const {
  const auto sameEntry = [](const Entry& a, const Entry& b) {
    return a.name == b.name && a.color == b.color && a.halfLife == b.halfLife;
  };
  return m_entries.size() == o.m_entries.size() &&
         std::equal(m_entries.begin(), m_entries.end(), o.m_entries.begin(), sameEntry) &&
         m_freeHalfLife == o.m_freeHalfLife && m_folds == o.m_folds &&
         m_unknownRawId == o.m_unknownRawId;
}

}  // namespace semantic_types
