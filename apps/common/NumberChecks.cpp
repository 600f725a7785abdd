#include "NumberChecks.h"

#include <cmath>
#include <memory>

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
