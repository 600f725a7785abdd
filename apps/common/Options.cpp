#include "Options.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace {

std::string withDashes(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

const std::string kOneOf = "one of ";

bool isChoice(const strict_files::Option& option) { return option.expected.rfind(kOneOf, 0) == 0; }

std::string helpOf(const strict_files::Option& option) {
  if (isChoice(option)) return option.help;
  const std::string unit = option.unit.empty() ? "" : ", " + option.unit;
  return option.help + unit + " (" + option.expected + ")";
}

/** "{compressed,halton}", as addWords() has it. */
std::string typeOf(const strict_files::Option& option) {
  if (!isChoice(option)) return "VALUE";
  std::string words;
  for (const char c : option.expected.substr(kOneOf.size()))
    if (c != ' ') words += c;
  return "{" + words + "}";
}

void addSwitch(CLI::App& app, const strict_files::Option& option, const std::string& group) {
  const bool on = option.text() == "true";
  const std::string name = withDashes(option.name);
  app.add_flag_callback((on ? "--no-" : "--") + name,
                        [set = option.set, on] { set(on ? "false" : "true"); },
                        (on ? "switches off: " : "") + option.help)
      ->group(group);
}

}  // namespace

void addOptions(CLI::App& app, const strict_files::OptionList& list, const std::string& group) {
  for (const strict_files::Option& option : list.options()) {
    if (option.isSwitch) {
      addSwitch(app, option, group);
      continue;
    }
    const std::string flag = "--" + withDashes(option.name);
    const auto read = [set = option.set, flag](const std::vector<std::string>& words) {
      try {
        set(words.back());
      } catch (const std::invalid_argument& e) {
        throw CLI::ValidationError(flag + " " + e.what());
      }
      return true;
    };
    app.add_option(flag, read, helpOf(option))
        ->type_name(typeOf(option))
        ->default_str(option.text())
        ->group(group);
  }
}

CLI::Validator isNumber(const strict_files::Range& range) {
  const auto number = std::make_shared<double>();
  strict_files::OptionList list;
  list.add("number", *number, "", range, "");
  const auto check = [number, option = list.options().front()](const std::string& text) {
    try {
      option.set(text);
      return std::string();
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
  };
  const bool bounded = std::isfinite(range.low) && std::isfinite(range.high);
  const std::string words =
      strict_files::textOf(range.low) + " to " + strict_files::textOf(range.high);
  return CLI::Validator(check, bounded ? words : "");
}
