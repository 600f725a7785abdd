#include <strict_files/OptionList.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

namespace strict_files {

namespace {

[[noreturn]] void refuse(const std::string& found, const std::string& expected) {
  throw std::invalid_argument("is " + found + ", expected " + expected);
}

std::string inWords(const Range& range, bool whole) {
  const bool low = std::isfinite(range.low) && range.low > -0x1p31;
  const bool high = std::isfinite(range.high) && range.high < 0x1p31 - 1;
  std::string words = whole ? "a whole number" : "a number";
  if (low && !range.withLow) words += " above " + textOf(range.low);
  if (low && range.withLow) words += (high ? " from " : " of ") + textOf(range.low);
  if (low && !high && range.withLow) words += " or more";
  if (high && !range.withHigh)
    words += std::string(low ? " and" : "") + " below " + textOf(range.high);
  if (high && range.withHigh)
    words += (!low ? " of at most " : range.withLow ? " to " : " up to ") + textOf(range.high);
  return words + (range.withInfinity ? ", or infinite" : "");
}

bool contains(const Range& range, double number) {
  if (std::isinf(number))
    return range.withInfinity && (number > 0 ? range.high : range.low) == number;
  return (range.withLow ? number >= range.low : number > range.low) &&
         (range.withHigh ? number <= range.high : number < range.high);
}

bool switchOf(const std::string& text, const std::string& expected) {
  for (const char* word : {"true", "yes", "on", "1"})
    if (sameWord(text, word)) return true;
  for (const char* word : {"false", "no", "off", "0"})
    if (sameWord(text, word)) return false;
  refuse("'" + text + "'", expected);
}

Eigen::Vector3d pointOf(const std::string& text, const std::string& expected) {
  std::istringstream parts(text);
  Eigen::Vector3d point;
  std::string part;
  for (int i = 0; i < 3; ++i) {
    if (!std::getline(parts, part, ',')) refuse("'" + text + "'", expected);
    point[i] = numberOf(trimmed(part), expected);
  }
  if (std::getline(parts, part) || !point.allFinite()) refuse("'" + text + "'", expected);
  return point;
}

}  // namespace

std::string textOf(double number) {
  if (std::isinf(number)) return number > 0 ? "inf" : "-inf";
  char text[40];
  const bool whole = number == std::floor(number) && std::fabs(number) < 0x1p53;  // no "1e+05"
  const auto end =
      whole ? std::to_chars(text, text + sizeof(text), number, std::chars_format::fixed).ptr
            : std::to_chars(text, text + sizeof(text), number).ptr;
  return {text, end};
}

double numberOf(const std::string& text, const std::string& expected) {
  double number = NAN;
  const char *first = text.data(), *const last = first + text.size();
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') ++first;
  const auto [end, error] = std::from_chars(first, last, number);
  if (error != std::errc() || end != last || std::isnan(number)) refuse("'" + text + "'", expected);
  return number;
}

std::vector<std::string> OptionList::names() const {
  std::vector<std::string> names;
  for (const Option& option : m_options) names.push_back(option.name);
  return names;
}

const Option* OptionList::find(const std::string& name) const {
  for (const Option& option : m_options)
    if (sameWord(option.name, name)) return &option;
  return nullptr;
}

void OptionList::remove(const std::string& name) {
  m_options.erase(std::remove_if(m_options.begin(), m_options.end(),
                                 [&](const Option& option) { return option.name == name; }),
                  m_options.end());
}

void OptionList::addNumber(const char* name, const char* unit, const char* help, const Range& range,
                           Number kind, const std::function<std::optional<double>()>& get,
                           const std::function<void(std::optional<double>)>& set) {
  const bool whole = kind == Number::Whole, mayBeNone = kind == Number::OrNone;
  const std::string expected = inWords(range, whole) + (mayBeNone ? ", or none" : "");
  const auto textOfIt = [get] {
    const auto number = get();
    return number ? textOf(*number) : std::string("none");
  };
  const auto setIt = [=](const std::string& text) {
    if (mayBeNone && sameWord(text, "none")) return set(std::nullopt);
    const double number = numberOf(text, expected);
    if (!contains(range, number) || (whole && number != std::floor(number))) refuse(text, expected);
    set(number);
  };
  m_options.push_back({name, unit, help, expected, false, textOfIt, setIt});
}

void OptionList::addWord(const char* name, const char* help, const std::vector<std::string>& words,
                         const std::function<std::string()>& get,
                         const std::function<void(std::size_t)>& set) {
  const std::string expected = "one of " + joined(words);
  const auto setIt = [=](const std::string& text) {
    for (std::size_t i = 0; i < words.size(); ++i)
      if (sameWord(words[i], text)) return set(i);
    refuse("'" + text + "'", expected + didYouMean(text, words));
  };
  m_options.push_back({name, "", help, expected, false, get, setIt});
}

void OptionList::addOther(const char* name, bool& value, const char* unit, const char* help) {
  const std::string expected = "true or false";
  const auto set = [&value, expected](const std::string& text) {
    value = switchOf(text, expected);
  };
  m_options.push_back(
      {name, unit, help, expected, true, [&value] { return value ? "true" : "false"; }, set});
}

void OptionList::addOther(const char* name, std::string& value, const char* unit,
                          const char* help) {
  m_options.push_back({name, unit, help, "text", false, [&value] { return value; },
                       [&value](const std::string& text) { value = text; }});
}

void OptionList::addOther(const char* name, Eigen::Vector3d& value, const char* unit,
                          const char* help) {
  const std::string expected = "three numbers x, y, z";
  const auto text = [&value] {
    return textOf(value.x()) + ", " + textOf(value.y()) + ", " + textOf(value.z());
  };
  const auto set = [&value, expected](const std::string& words) {
    value = pointOf(words, expected);
  };
  m_options.push_back({name, unit, help, expected, false, text, set});
}

void require(bool holds, const std::string& option, double value, const std::string& expected) {
  if (!holds)
    throw std::invalid_argument(option + " is " + textOf(value) + ", expected " + expected);
}

void checkAll(const OptionList& list, const std::string& owner) {
  for (const Option& option : list.options()) {
    try {
      option.set(option.text());
    } catch (const std::invalid_argument& e) {
      throw std::invalid_argument(owner + "::" + option.name + " " + e.what());
    }
  }
}

}  // namespace strict_files
