#include <labeled_cloud/IniSection.h>
#include <mrpt/system/string_utils.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace labeled_cloud {

IniSection::IniSection(const mrpt::config::CConfigFileBase& source, std::string section)
    : m_source(source), m_section(std::move(section)) {}

std::optional<std::string> IniSection::text(const std::string& key) {
  m_known.push_back(key);
  if (!m_source.keyExists(m_section, key)) return std::nullopt;
  const std::string line = " " + m_source.read_string(m_section, key, "");
  std::size_t end = line.size();
  for (const char* mark : {" //", " #", " ;", "\t//", "\t#", "\t;"})
    end = std::min(end, line.find(mark));
  return mrpt::system::trim(line.substr(0, end));
}

void IniSection::read(const std::string& key, std::string& value) {
  if (const auto found = text(key)) value = *found;
}

void IniSection::read(const std::string& key, double& value) {
  const auto found = text(key);
  if (!found) return;
  char* end = nullptr;
  const double number = std::strtod(found->c_str(), &end);
  if (found->empty() || *end != '\0' || std::isnan(number))
    fail(key + " is '" + *found + "', expected a number");
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

}  // namespace labeled_cloud
