#pragma once
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace strict_files {

/** Throws std::invalid_argument naming struct, field, value and what was expected. */
class OptionChecks {
 public:
  explicit OptionChecks(const char* options) : m_options(options) {}

  [[noreturn]] void fail(const char* field, const std::string& problem) const {
    throw std::invalid_argument(std::string(m_options) + "::" + field + " " + problem);
  }
  void positive(const char* field, double value) const {
    if (!(value > 0) || !std::isfinite(value)) refuse(field, value, "above 0");
  }
  void notNegative(const char* field, double value) const {
    if (!(value >= 0) || !std::isfinite(value)) refuse(field, value, "0 or more");
  }
  void within(const char* field, double value, double low, double high) const {
    if (value >= low && value <= high) return;
    std::ostringstream range;
    range << low << " to " << high;
    refuse(field, value, range.str());
  }

 private:
  [[noreturn]] void refuse(const char* field, double value, const std::string& expected) const {
    std::ostringstream problem;
    problem << "is " << value << ", expected " << expected;
    fail(field, problem.str());
  }

  const char* m_options;
};

}  // namespace strict_files
