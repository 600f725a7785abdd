#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace strict_files {

/** The names of an enumeration's values in files and on command lines, in the order to list them.
 * An enumeration that has options of its kind gives them by `choicesOf(E)` in its namespace. */
template <class E>
using Choices = std::vector<std::pair<const char*, E>>;

/** The name of a value. \throw std::out_of_range it has none. */
template <class E>
const char* nameIn(const Choices<E>& choices, E value) {
  for (const auto& [name, choice] : choices)
    if (choice == value) return name;
  throw std::out_of_range("a value without a name");
}

/** Which numbers an option may be: `atLeast(0).below(1)`. */
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool withLow = true;        ///< low itself is allowed
  bool withInfinity = false;  ///< an end that is infinite is allowed
  bool withHigh = true;       ///< high itself is allowed

  Range upTo(double most) const { return {low, most, withLow, withInfinity, true}; }
  Range below(double end) const { return {low, end, withLow, withInfinity, false}; }
  Range orInfinite() const { return {low, high, withLow, true, withHigh}; }
};
inline Range above(double low) { return {low, Range().high, false}; }
inline Range atLeast(double low) { return {low}; }
inline Range between(double low, double high) { return {low, high}; }

/** One option of a struct, with what files, command lines and documents need of it. */
struct Option {
  std::string name;      ///< lower case, words parted by "_"
  std::string unit;      ///< "m", or empty
  std::string help;      ///< a phrase; no full stop
  std::string expected;  ///< what its value may be, in words: "a number above 0"
  bool isSwitch = false;
  std::function<std::string()> text = {};  ///< the value, so that set() takes it
  /** \throw std::invalid_argument "is 'x', expected a number" */
  std::function<void(const std::string&)> set = {};
};

/** The options of a struct, described once. How they are read from .ini files, YAML and command
 * lines, what is allowed, and their page in the handbook follow from this list.
 *
 *     void GroundOptions::describe(strict_files::OptionList& list) {
 *       list.add("step", step, "m", atLeast(0), "highest step that the wheels take");
 *     }
 *
 * The list refers to the struct, which must outlive it. Values that are set are not checked against
 * each other: that is for the struct's validate(), which begins with checkOptions(). */
class OptionList {
 public:
  /** The options of structs that describe themselves. */
  template <class... Structs>
  static OptionList of(Structs&... structs) {
    OptionList list;
    (structs.describe(list), ...);
    return list;
  }

  /** double, float, whole numbers, std::optional<double> ("none" without), bool, std::string,
   * Eigen::Vector3d ("x, y, z"), and enumerations with choicesOf(). */
  template <class T>
  void add(const char* name, T& value, const char* unit, const Range& range, const char* help) {
    if constexpr (std::is_enum_v<T>)
      addChoice(name, value, help);
    else if constexpr (std::is_same_v<T, std::optional<double>>)
      addNumber(
          name, unit, help, range, Number::OrNone, [&value] { return value; },
          [&value](std::optional<double> number) { value = number; });
    else if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>)
      addNumber(
          name, unit, help, rangeOf<T>(range), std::is_integral_v<T> ? Number::Whole : Number::Any,
          [&value] { return static_cast<double>(value); },
          [&value](std::optional<double> number) { value = static_cast<T>(*number); });
    else
      addOther(name, value, unit, help);
  }
  /** Numbers of any size, and what is no number. */
  template <class T>
  void add(const char* name, T& value, const char* unit, const char* help) {
    add(name, value, unit, Range(), help);
  }

  const std::vector<Option>& options() const& { return m_options; }
  std::vector<Option> options() && { return std::move(m_options); }
  std::vector<std::string> names() const;
  /** The option with this name (sameWord()), or null. */
  const Option* find(const std::string& name) const;
  /** Leaves out an option, where a program knows it otherwise. */
  void remove(const std::string& name);

 private:
  enum class Number { Any, Whole, OrNone };

  /** Within what the type holds. */
  template <class T>
  static Range rangeOf(Range range) {
    using Limits = std::numeric_limits<T>;
    if (!Limits::is_integer) return range;
    range.low = std::max(range.low, static_cast<double>(Limits::lowest()));
    range.high = std::min({range.high, static_cast<double>(Limits::max()), 0x1p53});
    return range;
  }
  template <class E>
  void addChoice(const char* name, E& value, const char* help) {
    std::vector<std::string> words;
    for (const auto& choice : choicesOf(E())) words.push_back(choice.first);
    addWord(
        name, help, words, [&value] { return std::string(nameIn(choicesOf(E()), value)); },
        [&value](std::size_t i) { value = choicesOf(E())[i].second; });
  }
  void addNumber(const char* name, const char* unit, const char* help, const Range& range,
                 Number kind, const std::function<std::optional<double>()>& get,
                 const std::function<void(std::optional<double>)>& set);
  void addWord(const char* name, const char* help, const std::vector<std::string>& words,
               const std::function<std::string()>& get,
               const std::function<void(std::size_t)>& set);
  void addOther(const char* name, bool& value, const char* unit, const char* help);
  void addOther(const char* name, std::string& value, const char* unit, const char* help);
  void addOther(const char* name, Eigen::Vector3d& value, const char* unit, const char* help);

  std::vector<Option> m_options;
};

/** Sets each option to what it is. \throw std::invalid_argument "owner::option is ...": a value is
 * not what it may be. */
void checkAll(const OptionList& list, const std::string& owner);

/** \param options a struct with describe(OptionList&) \param owner its name, for errors
 * \throw std::invalid_argument naming struct, option and value: one is not what it may be. */
template <class T>
void checkOptions(const T& options, const std::string& owner) {
  T copy = options;
  checkAll(OptionList::of(copy), owner);
}
/** For what options say about each other, in validate().
 * \param option "Struct::option", for errors
 * \throw std::invalid_argument "Struct::option is 3, expected at most max_height" unless it holds.
 */
void require(bool holds, const std::string& option, double value, const std::string& expected);

/** Numbers as files have them: as many digits as are needed to read the same number again. */
std::string textOf(double number);
/** \throw std::invalid_argument "is 'x', expected a number": not all of the text is one, or it is
 * NaN. */
double numberOf(const std::string& text, const std::string& expected = "a number");

}  // namespace strict_files
