#include <labeled_cloud/ClassTableFile.h>
#include <labeled_cloud/StagedFile.h>
#include <yaml-cpp/yaml.h>

#include <fstream>
#include <set>
#include <stdexcept>

// yaml-cpp and not mrpt::containers::yaml: MRPT's reader (2.5.8) stops at a syntax error without
// telling, so a damaged table would become a shorter one.
namespace labeled_cloud {

using semantic_octree::ClassId;
using semantic_octree::ClassTable;
using semantic_octree::Color;
using semantic_octree::kMaxClasses;
using semantic_octree::kNoClass;

namespace {

/** Reads one file; its errors name file and line. */
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : m_file(file.string()) {}

  ClassTable read() {
    const YAML::Node root = parse();
    checkKeys(root, {"unknown_raw_id", "no_class", "classes"});
    for (const auto& entry : inOrderOfId(required(root, "classes"))) addClass(entry);
    foldAll(root["no_class"], kNoClass);
    m_table.setUnknownRawId(unknownRawId(root["unknown_raw_id"]));
    return m_table;
  }

 private:
  using Policy = ClassTable::UnknownRawId;

  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& what) const {
    const std::string line = mark.is_null() ? "" : ":" + std::to_string(mark.line + 1);
    throw std::runtime_error(m_file + line + ": " + what);
  }

  YAML::Node parse() const {
    std::ifstream stream(m_file);
    if (!stream) fail(YAML::Mark::null_mark(), "the class table cannot be opened");
    try {
      return YAML::Load(stream);
    } catch (const YAML::Exception& e) {
      fail(e.mark, e.msg);
    }
  }

  void checkKeys(const YAML::Node& node, const std::set<std::string>& known) const {
    if (!node.IsMap()) fail(node.Mark(), "expected 'key: value' entries");
    std::set<std::string> seen;
    for (const auto& entry : node) {
      const auto key = value<std::string>(entry.first, "a key");
      if (!known.count(key)) fail(entry.first.Mark(), "unknown key '" + key + "'");
      if (!seen.insert(key).second) fail(entry.first.Mark(), "key '" + key + "' twice");
    }
  }

  YAML::Node required(const YAML::Node& node, const std::string& key) const {
    const YAML::Node found = node[key];
    if (!found) fail(node.Mark(), "key '" + key + "' is missing");
    return found;
  }

  template <typename T>
  T value(const YAML::Node& node, const std::string& expected) const {
    try {
      return node.as<T>();
    } catch (const YAML::Exception&) {
      const std::string found = node.IsScalar() ? "'" + node.Scalar() + "'" : "something else";
      fail(node.Mark(), "expected " + expected + ", found " + found);
    }
  }

  std::vector<YAML::Node> inOrderOfId(const YAML::Node& classes) const {
    if (!classes.IsSequence() || classes.size() == 0 || classes.size() > kMaxClasses)
      fail(classes.Mark(), "classes: expected a list of 1 to 254 classes");
    const int count = static_cast<int>(classes.size());
    std::vector<YAML::Node> ordered(count);
    std::vector<bool> seen(count, false);
    for (const auto& entry : classes) {
      checkKeys(entry, {"id", "name", "color", "raw"});
      const int id = value<int>(required(entry, "id"), "a class id");
      if (id < 1 || id > count)
        fail(entry.Mark(), "class id " + std::to_string(id) + ": the ids of " +
                               std::to_string(count) + " classes must be 1.." +
                               std::to_string(count) + " without gaps");
      if (seen[id - 1]) fail(entry.Mark(), "class id " + std::to_string(id) + " twice");
      seen[id - 1] = true;
      ordered[id - 1].reset(entry);
    }
    return ordered;
  }

  void addClass(const YAML::Node& entry) {
    const auto name = value<std::string>(required(entry, "name"), "the class's name");
    const Color rgb = color(required(entry, "color"));
    const ClassId id = located(entry, [&] { return m_table.add(name, rgb); });
    foldAll(entry["raw"], id);
  }

  Color color(const YAML::Node& node) const {
    const std::string expected = "color: [r, g, b], each 0..255";
    if (!node.IsSequence() || node.size() != 3) fail(node.Mark(), "expected " + expected);
    std::uint8_t rgb[3];
    for (int i = 0; i < 3; ++i) {
      const int channel = value<int>(node[i], expected);
      if (channel < 0 || channel > 255)
        fail(node[i].Mark(), "expected " + expected + ", found " + std::to_string(channel));
      rgb[i] = static_cast<std::uint8_t>(channel);
    }
    return {rgb[0], rgb[1], rgb[2]};
  }

  void foldAll(const YAML::Node& rawIds, ClassId id) {
    if (!rawIds) return;
    if (!rawIds.IsSequence()) fail(rawIds.Mark(), "expected a list of raw ids");
    for (const auto& raw : rawIds)
      located(raw, [&] {
        m_table.fold(value<std::uint32_t>(raw, "a raw id"), id);
        return id;
      });
  }

  Policy unknownRawId(const YAML::Node& node) const {
    if (!node) return Policy::Error;
    const auto text = value<std::string>(node, "error or no_class");
    if (text == "error") return Policy::Error;
    if (text == "no_class") return Policy::NoClass;
    fail(node.Mark(), "unknown_raw_id: expected error or no_class, found '" + text + "'");
  }

  /** Runs ACTION on the table and adds file and line to what the table complains about. */
  template <typename Action>
  ClassId located(const YAML::Node& node, Action action) const {
    try {
      return action();
    } catch (const std::invalid_argument& e) {
      fail(node.Mark(), e.what());
    }
  }

  std::string m_file;
  ClassTable m_table;
};

std::vector<std::uint32_t> rawIdsOf(const ClassTable& table, ClassId id) {
  std::vector<std::uint32_t> rawIds;
  for (const auto& [raw, folded] : table.folds())
    if (folded == id) rawIds.push_back(raw);
  return rawIds;
}

YAML::Emitter& operator<<(YAML::Emitter& out, const Color& c) {
  return out << YAML::Flow << std::vector<int>{c.r, c.g, c.b};
}

void emitRawIds(YAML::Emitter& out, const char* key, const std::vector<std::uint32_t>& rawIds) {
  if (!rawIds.empty()) out << YAML::Key << key << YAML::Value << YAML::Flow << rawIds;
}

void emit(YAML::Emitter& out, const ClassTable& table) {
  const bool error = table.unknownRawId() == ClassTable::UnknownRawId::Error;
  out << YAML::BeginMap << YAML::Key << "unknown_raw_id" << (error ? "error" : "no_class");
  emitRawIds(out, "no_class", rawIdsOf(table, kNoClass));
  out << YAML::Key << "classes" << YAML::BeginSeq;
  for (int id = 1; id <= table.size(); ++id) {
    out << YAML::Flow << YAML::BeginMap << YAML::Key << "id" << id << YAML::Key << "name"
        << YAML::DoubleQuoted << table.name(id) << YAML::Key << "color" << table.color(id);
    emitRawIds(out, "raw", rawIdsOf(table, id));
    out << YAML::EndMap;
  }
  out << YAML::EndSeq << YAML::EndMap << YAML::Newline;
}

}  // namespace

ClassTable loadClassTable(const std::filesystem::path& file) { return Reader(file).read(); }

void saveClassTable(const ClassTable& table, const std::filesystem::path& file) {
  StagedFile staged(file);
  YAML::Emitter text;
  emit(text, table);
  std::ofstream stream(staged.path());
  stream << text.c_str();
  stream.close();
  if (!stream) throw std::runtime_error(file.string() + ": the class table cannot be written");
  staged.commit();
}

}  // namespace labeled_cloud
