#include <semantic_types/ClassTable.h>

#include <strict_files/OptionList.h>
#include <strict_files/StrictYaml.h>
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
                                strict_files::textOf(seconds) + " s, expected 0.001 to 1000000000");
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

namespace {

/** Reads one file; its errors name file and line. */
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : m_yaml(file) {}

  ClassTable read() {
    const YAML::Node& root = m_yaml.root();
    m_yaml.checkKeys(root, {"unknown_raw_id", "no_class", "free_half_life", "classes"});
    for (const auto& entry : inOrderOfId(m_yaml.required(root, "classes"))) addClass(entry);
    foldAll(root["no_class"], kNoClass);
    setHalfLife(root["free_half_life"], kNoClass);
    m_table.setUnknownRawId(unknownRawId(root["unknown_raw_id"]));
    return m_table;
  }

 private:
  using Policy = ClassTable::UnknownRawId;

  std::vector<YAML::Node> inOrderOfId(const YAML::Node& classes) const {
    if (!classes.IsSequence() || classes.size() == 0 || classes.size() > kMaxClasses)
      m_yaml.fail(classes, "classes: expected a list of 1 to 254 classes");
    const int count = static_cast<int>(classes.size());
    std::vector<YAML::Node> ordered(count);
    std::vector<bool> seen(count, false);
    for (const auto& entry : classes) {
      m_yaml.checkKeys(entry, {"id", "name", "color", "half_life", "raw"});
      const int id = m_yaml.value<int>(m_yaml.required(entry, "id"), "a class id");
      if (id < 1 || id > count)
        m_yaml.fail(entry, "class id " + std::to_string(id) + ": the ids of " +
                               std::to_string(count) + " classes must be 1.." +
                               std::to_string(count) + " without gaps");
      if (seen[id - 1]) m_yaml.fail(entry, "class id " + std::to_string(id) + " twice");
      seen[id - 1] = true;
      ordered[id - 1].reset(entry);
    }
    return ordered;
  }

  void addClass(const YAML::Node& entry) {
    const auto name = m_yaml.text(m_yaml.required(entry, "name"), "name");
    const Color rgb = color(m_yaml.required(entry, "color"));
    const ClassId id = located(entry, [&] { return m_table.add(name, rgb); });
    setHalfLife(entry["half_life"], id);
    foldAll(entry["raw"], id);
  }

  void setHalfLife(const YAML::Node& node, ClassId id) {
    if (!node) return;
    const double seconds = m_yaml.number(node, "half-life in seconds");
    located(node, [&] {
      m_table.setHalfLife(id, seconds);
      return id;
    });
  }

  Color color(const YAML::Node& node) const {
    const std::string expected = "color: [r, g, b], each 0..255";
    if (!node.IsSequence() || node.size() != 3) m_yaml.fail(node, "expected " + expected);
    std::uint8_t rgb[3];
    for (int i = 0; i < 3; ++i) {
      const int channel = m_yaml.value<int>(node[i], expected);
      if (channel < 0 || channel > 255)
        m_yaml.fail(node[i], "expected " + expected + ", found " + std::to_string(channel));
      rgb[i] = static_cast<std::uint8_t>(channel);
    }
    return {rgb[0], rgb[1], rgb[2]};
  }

  void foldAll(const YAML::Node& rawIds, ClassId id) {
    if (!rawIds) return;
    if (!rawIds.IsSequence()) m_yaml.fail(rawIds, "expected a list of raw ids");
    for (const auto& raw : rawIds)
      located(raw, [&] {
        m_table.fold(m_yaml.value<std::uint32_t>(raw, "a raw id"), id);
        return id;
      });
  }

  Policy unknownRawId(const YAML::Node& node) const {
    if (!node) return Policy::Error;
    const auto text = m_yaml.text(node, "unknown_raw_id");
    if (text == "error") return Policy::Error;
    if (text == "no_class") return Policy::NoClass;
    m_yaml.fail(node, "unknown_raw_id: expected error or no_class, found '" + text + "'");
  }

  /** Runs ACTION on the table and adds file and line to what the table complains about. */
  template <typename Action>
  ClassId located(const YAML::Node& node, Action action) const {
    try {
      return action();
    } catch (const std::invalid_argument& e) {
      m_yaml.fail(node, e.what());
    }
  }

  strict_files::StrictYaml m_yaml;
  ClassTable m_table;
};

}  // namespace

ClassTable loadClassTable(const std::filesystem::path& file) { return Reader(file).read(); }

}  // namespace semantic_types
