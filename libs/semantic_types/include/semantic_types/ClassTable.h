#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace semantic_types {

/** Number of a class: 1 to K. 0 is free space in a map and "no class" on a point. */
using ClassId = std::uint8_t;
constexpr ClassId kNoClass = 0;
constexpr int kMaxClasses = 254;
/** Half-life of what a map does not forget, seconds. */
constexpr double kForever = std::numeric_limits<double>::infinity();

struct Color {
  std::uint8_t r = 0, g = 0, b = 0;
  bool operator==(const Color& o) const { return r == o.r && g == o.g && b == o.b; }
};

/** The classes of a map, and how the ids of a data set ("raw ids") fold into them.
 *
 * Class ids are 1..K without gaps. Names are unique and not empty. In a table that folds no raw id
 * to a class, raw ids are the classes' own. */
class ClassTable {
 public:
  struct Entry {
    std::string name;
    Color color;
    double halfLife = kForever;
  };
  enum class UnknownRawId { Error, NoClass };

  /** Appends a class and returns its id.
   * \throw std::invalid_argument name empty, used already, with control characters, or not UTF-8;
   * more than 254 classes. */
  ClassId add(const std::string& name, Color color);

  /** Number of classes K, free space not counted. */
  int size() const { return static_cast<int>(m_entries.size()); }
  bool empty() const { return m_entries.empty(); }
  bool contains(ClassId id) const { return id >= 1 && id <= size(); }

  /** Name and color. kNoClass (free or unknown space, no label) is "no class", and gray.
   * \throw std::out_of_range id is above K. */
  const std::string& name(ClassId id) const { return entry(id).name; }
  const Color& color(ClassId id) const { return entry(id).color; }

  /** Seconds after which a map that sees nothing more of a class is half as sure of it; kForever
   * unless it was set. That of kNoClass is free space's. \throw std::out_of_range id is above K. */
  double halfLife(ClassId id) const { return id == kNoClass ? m_freeHalfLife : entry(id).halfLife; }
  /** \throw std::out_of_range id is above K \throw std::invalid_argument neither kForever nor
   * 0.001 to 1e9 seconds. */
  void setHalfLife(ClassId id, double seconds);
  /** Whether anything has a half-life. */
  bool hasHalfLives() const;

  /** Class with this name, if any. */
  std::optional<ClassId> find(const std::string& name) const;
  /** Class with this exact color, if any (the lowest id if several share it). */
  std::optional<ClassId> find(Color color) const;

  /** Raw id -> class id (or kNoClass).
   * \throw std::invalid_argument raw id folded already, or class id not in the table. */
  void fold(std::uint32_t rawId, ClassId id);
  /** What to make of a raw id that the table does not know. */
  void setUnknownRawId(UnknownRawId policy) { m_unknownRawId = policy; }
  UnknownRawId unknownRawId() const { return m_unknownRawId; }

  /** Class of a data set's raw id.
   * \throw std::invalid_argument naming the raw id, if the table does not know it and
   * unknownRawId() is Error. */
  ClassId fromRaw(std::uint32_t rawId) const;
  /** The explicit folds, for files. */
  const std::map<std::uint32_t, ClassId>& folds() const { return m_folds; }

  bool operator==(const ClassTable& o) const;
  bool operator!=(const ClassTable& o) const { return !(*this == o); }

 private:
  const Entry& entry(ClassId id) const;

  std::vector<Entry> m_entries;
  double m_freeHalfLife = kForever;
  std::map<std::string, ClassId> m_ids;
  std::map<std::uint32_t, ClassId> m_folds;
  bool m_hasOwnRawIds = true;  ///< no raw id folds to a class
  UnknownRawId m_unknownRawId = UnknownRawId::Error;
};

/** Whatever is drawn where no class was ever seen. */
constexpr Color kColorWithoutClass{150, 150, 150};

/** A class's color, or the gray of those without. \throw std::out_of_range id is not 0..K. */
inline Color colorOf(ClassId id, const ClassTable& classes) {
  return id == kNoClass ? kColorWithoutClass : classes.color(id);
}

/** Red (0) over yellow to green (1). */
inline Color trafficLight(double value) {
  const double v = std::clamp(value, 0.0, 1.0);
  const auto byteOf = [](double x) { return static_cast<std::uint8_t>(x + 0.5); };
  return {byteOf(235 * std::min(1.0, 2 - 2 * v)), byteOf(215 * std::min(1.0, 2 * v)), 30};
}

/** Reads a class table from a YAML file:
 *
 *     unknown_raw_id: error        # or no_class; may be left out (error)
 *     no_class: [0, 1]             # raw ids of a data set that mean "no class"; may be left out
 *     free_half_life: 3600         # of free space, seconds; may be left out (never forgotten)
 *     classes:                     # ids 1..K without gaps, in any order
 *       - {id: 1, name: road, color: [128, 64, 128], raw: [40, 60]}  # raw may be left out
 *       - {id: 2, name: person, color: [220, 20, 60], half_life: 2}  # seconds; may be left out
 *
 * \throw std::runtime_error naming file, line and value: unreadable, YAML syntax, wrong keys, ids
 * with gaps or twice, colors not 0..255, half-lives not 0.001 to 1e9 s, a raw id or name twice. */
ClassTable loadClassTable(const std::filesystem::path& file);

}  // namespace semantic_types
