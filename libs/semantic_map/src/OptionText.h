#pragma once
#include <semantic_map/MapOptions.h>

#include <string>
#include <type_traits>
#include <vector>

namespace semantic_map {

/** The names of an enumeration's values, in their order from 0. */
const std::vector<std::string>& namesOf(semantic_octree::InsertionOptions::Rays);
const std::vector<std::string>& namesOf(semantic_octree::FilterParameters::Increments);
const std::vector<std::string>& namesOf(semantic_octree::AbstractionOptions::Unknown);
const std::vector<std::string>& namesOf(semantic_octree::AbstractionOptions::Frame);
const std::vector<std::string>& namesOf(TRenderingOptions::Coloring);

/** Values of options as text, without loss.
 * parseOption(): \throw std::invalid_argument what was expected. */
void parseOption(const std::string& text, bool& value);
void parseOption(const std::string& text, int& value);
void parseOption(const std::string& text, double& value);
void parseOption(const std::string& text, std::string& value);

std::string formatOption(bool value);
std::string formatOption(int value);
std::string formatOption(double value);
std::string formatOption(const std::string& value);

/** Position of the text among the names. \throw std::invalid_argument the names. */
int parseName(const std::string& text, const std::vector<std::string>& names);

template <class Enum>
std::enable_if_t<std::is_enum_v<Enum>> parseOption(const std::string& text, Enum& value) {
  value = static_cast<Enum>(parseName(text, namesOf(value)));
}
template <class Enum>
std::enable_if_t<std::is_enum_v<Enum>, std::string> formatOption(Enum value) {
  return namesOf(value).at(static_cast<std::size_t>(value));
}

}  // namespace semantic_map
