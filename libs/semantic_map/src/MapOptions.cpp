#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/serialization/CArchive.h>
#include <semantic_map/MapOptions.h>
#include <strict_files/IniSection.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <stdexcept>

#include "OptionFields.h"
#include "OptionText.h"

namespace semantic_map {

using mrpt::config::CConfigFileBase;
using mrpt::serialization::CArchive;
using strict_files::IniSection;

namespace {

/** Options that MRPT itself reads from a section of the map. */
std::vector<std::string> foreignKeys(const TCreationOptions&) {
  return {"enableSaveAs3DObject", "enableObservationLikelihood", "enableObservationInsertion"};
}
template <class Other>
std::vector<std::string> foreignKeys(const Other&) {
  return {};
}

/** Enumerations as one byte, numbers as they are. */
template <class Value>
void writeValue(CArchive& out, const Value& value) {
  if constexpr (std::is_enum_v<Value>)
    out.WriteAs<std::uint8_t>(static_cast<int>(value));
  else if constexpr (std::is_same_v<Value, int>)
    out.WriteAs<std::int32_t>(value);
  else
    out << value;
}

template <class Value>
void readValue(CArchive& in, Value& value) {
  if constexpr (std::is_enum_v<Value>) {
    const std::size_t number = in.ReadAs<std::uint8_t>();
    if (number >= namesOf(value).size())
      throw std::runtime_error("there is no value " + std::to_string(number));
    value = static_cast<Value>(number);
  } else if constexpr (std::is_same_v<Value, int>) {
    value = in.ReadAs<std::int32_t>();
  } else {
    in >> value;
  }
}

void require(bool fine, const char* option, double value, const char* expected) {
  if (!fine)
    throw std::invalid_argument(std::string(option) + " is " + formatOption(value) + ", expected " +
                                expected);
}

bool isProbability(double p) { return p >= 0 && p <= 1; }

}  // namespace

template <class Derived>
void TNamedOptions<Derived>::loadFromConfigFile(const CConfigFileBase& source,
                                                const std::string& section) {
  Derived loaded = static_cast<Derived&>(*this);
  IniSection ini(source, section);
  OptionFields<Derived>::visit(loaded, [&ini](const char* key, auto& value, const char*) {
    const auto text = ini.text(key);
    if (!text) return;
    try {
      parseOption(*text, value);
    } catch (const std::invalid_argument& expected) {
      ini.fail(std::string(key) + " is '" + *text + "', expected " + expected.what());
    }
  });
  for (const std::string& key : foreignKeys(loaded)) ini.text(key);
  ini.finish();
  try {
    loaded.validate();
  } catch (const std::invalid_argument& e) {
    ini.fail(e.what());
  }
  static_cast<Derived&>(*this) = loaded;
}

template <class Derived>
void TNamedOptions<Derived>::saveToConfigFile(CConfigFileBase& target,
                                              const std::string& section) const {
  OptionFields<Derived>::visit(static_cast<const Derived&>(*this),
                               [&](const char* key, const auto& value, const char* explanation) {
                                 // No padding, which MRPT would take for a part of the key.
                                 target.write(section, key, formatOption(value), -1, -1,
                                              explanation);
                               });
}

template <class Derived>
void TNamedOptions<Derived>::dumpToTextStream(std::ostream& out) const {
  OptionFields<Derived>::visit(static_cast<const Derived&>(*this),
                               [&](const char* key, const auto& value, const char* explanation) {
                                 out << "  " << key << " = " << formatOption(value) << "  // "
                                     << explanation << "\n";
                               });
}

template <class Derived>
void TNamedOptions<Derived>::writeTo(CArchive& out) const {
  OptionFields<Derived>::visit(
      static_cast<const Derived&>(*this),
      [&out](const char*, const auto& value, const char*) { writeValue(out, value); });
}

template <class Derived>
void TNamedOptions<Derived>::readFrom(CArchive& in) {
  Derived read = static_cast<Derived&>(*this);
  OptionFields<Derived>::visit(
      read, [&in](const char*, auto& value, const char*) { readValue(in, value); });
  read.validate();
  static_cast<Derived&>(*this) = read;
}

void TCreationOptions::validate() const {
  require(std::isfinite(resolution) && resolution > 0, "resolution", resolution, "more than 0 m");
}

void TInsertionOptions::validate() const {
  scan.validate();
  conversion.validate();
}

void TLikelihoodOptions::validate() const {
  require(decimation >= 1, "decimation", decimation, "1 or more");
  require(std::isfinite(beamStep) && beamStep >= 0, "beamStep", beamStep, "0 or more m");
  require(pointWeight > 0 && pointWeight <= 1, "pointWeight", pointWeight, "above 0, up to 1");
}

void TRenderingOptions::validate() const {
  require(isProbability(minOccupancy), "minOccupancy", minOccupancy, "0 to 1");
  require(isProbability(minProbability), "minProbability", minProbability, "0 to 1");
  require(minHeight <= maxHeight, "minHeight", minHeight, "at most maxHeight");
}

template class TNamedOptions<TCreationOptions>;
template class TNamedOptions<TInsertionOptions>;
template class TNamedOptions<TLikelihoodOptions>;
template class TNamedOptions<TAbstractionOptions>;
template class TNamedOptions<TRenderingOptions>;

}  // namespace semantic_map
