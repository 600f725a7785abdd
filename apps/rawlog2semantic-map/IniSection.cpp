#include "IniSection.h"

#include <mrpt/system/string_utils.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace rawlog2semantic_map {

IniSection::IniSection(const mrpt::config::CConfigFileBase& source, std::string section)
    : m_source(source), m_section(std::move(section)) {}

void IniSection::read(const std::string& key, std::string& value) {
  m_known.push_back(key);
  if (!m_source.keyExists(m_section, key)) return;
  std::string text = m_source.read_string(m_section, key, "");
  // MRPT leaves comments behind values where they are.
  for (const char* mark : {" //", " #", " ;", "\t//", "\t#", "\t;"})
    text.erase(std::min(text.find(mark), text.size()));
  value = mrpt::system::trim(text);
}

void IniSection::read(const std::string& key, double& value) {
  std::string text;
  read(key, text);
  if (text.empty()) return;
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (*end != '\0' || std::isnan(number)) fail(key + " is '" + text + "', expected a number");
  value = number;
}

void IniSection::read(const std::string& key, int& value) {
  double number = value;
  read(key, number);
  if (number != std::floor(number) || std::fabs(number) > 1e9)
    fail(key + " is " + std::to_string(number) + ", expected a whole number");
  value = static_cast<int>(number);
}

void IniSection::fail(const std::string& what) const {
  throw std::runtime_error("[" + m_section + "] " + what);
}

void IniSection::finish() const {
  std::vector<std::string> present;
  m_source.getAllKeys(m_section, present);
  for (const std::string& key : present) {
    const auto same = [&key](const std::string& k) { return mrpt::system::strCmpI(k, key); };
    if (std::any_of(m_known.begin(), m_known.end(), same)) continue;
    std::string list;
    for (const std::string& k : m_known) list += (list.empty() ? "" : ", ") + k;
    fail("unknown key '" + key + "'; known are " + list);
  }
}

}  // namespace rawlog2semantic_map
