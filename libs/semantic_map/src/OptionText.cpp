#include "OptionText.h"

#include <mrpt/system/string_utils.h>

#include <array>
#include <charconv>
#include <stdexcept>

namespace semantic_map {

const std::vector<std::string>& namesOf(semantic_octree::InsertionOptions::Rays) {
  static const std::vector<std::string> names = {"All", "EndVoxels"};
  return names;
}

const std::vector<std::string>& namesOf(semantic_octree::FilterParameters::Increments) {
  static const std::vector<std::string> names = {"LikelihoodConsistent", "Ssmi"};
  return names;
}

const std::vector<std::string>& namesOf(semantic_octree::AbstractionOptions::Unknown) {
  static const std::vector<std::string> names = {"OwnClass", "Uniform", "Prior"};
  return names;
}

const std::vector<std::string>& namesOf(semantic_octree::AbstractionOptions::Frame) {
  static const std::vector<std::string> names = {"Free", "Charged"};
  return names;
}

const std::vector<std::string>& namesOf(TRenderingOptions::Coloring) {
  static const std::vector<std::string> names = {"Class", "Probability", "Height", "Entropy"};
  return names;
}

int parseName(const std::string& text, const std::vector<std::string>& names) {
  std::string expected;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (mrpt::system::strCmpI(text, names[i])) return static_cast<int>(i);
    expected += (i ? " or " : "") + names[i];
  }
  throw std::invalid_argument(expected);
}

namespace {

template <class Number>
Number parseNumber(const std::string& text, const char* expected) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw std::invalid_argument(expected);
  return value;
}

}  // namespace

void parseOption(const std::string& text, bool& value) {
  const auto is = [&text](const char* s) { return mrpt::system::strCmpI(text, s); };
  const bool yes = is("true") || is("yes") || is("1"), no = is("false") || is("no") || is("0");
  if (!yes && !no) throw std::invalid_argument("true or false");
  value = yes;
}

void parseOption(const std::string& text, int& value) {
  value = parseNumber<int>(text, "a whole number");
}

void parseOption(const std::string& text, double& value) {
  value = parseNumber<double>(text, "a number");
}

void parseOption(const std::string& text, std::string& value) { value = text; }

std::string formatOption(bool value) { return value ? "true" : "false"; }

std::string formatOption(int value) { return std::to_string(value); }

std::string formatOption(double value) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string formatOption(const std::string& value) { return value; }

}  // namespace semantic_map
