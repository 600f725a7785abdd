#pragma once
#include <mrpt/config/CConfigFileBase.h>

#include <string>
#include <vector>

namespace rawlog2semantic_map {

/** Reads a section of an .ini file into options, strictly: call read() for each option, then
 * finish(). Keys that are absent leave their option as it is. */
class IniSection {
 public:
  IniSection(const mrpt::config::CConfigFileBase& source, std::string section);

  /** \throw std::runtime_error naming section, key and value: no number, or no number of this kind.
   */
  void read(const std::string& key, double& value);
  void read(const std::string& key, int& value);
  void read(const std::string& key, std::string& value);

  /** \throw std::runtime_error naming the section. */
  [[noreturn]] void fail(const std::string& what) const;
  /** \throw std::runtime_error naming section and key: a key that was not read. */
  void finish() const;

 private:
  const mrpt::config::CConfigFileBase& m_source;
  std::string m_section;
  std::vector<std::string> m_known;
};

}  // namespace rawlog2semantic_map
