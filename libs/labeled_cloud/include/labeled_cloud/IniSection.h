#pragma once
#include <mrpt/config/CConfigFileBase.h>

#include <optional>
#include <string>
#include <vector>

namespace labeled_cloud {

/** Reads a section of an .ini file into options, strictly, where MRPT ignores keys it does not
 * know: call read() or text() for each option, then finish(). Keys that are absent leave their
 * option as it is. */
class IniSection {
 public:
  /** \param source must outlive the section. */
  IniSection(const mrpt::config::CConfigFileBase& source, std::string section);

  /** The value without a comment behind it, which MRPT leaves there; nothing if the key is absent.
   */
  std::optional<std::string> text(const std::string& key);

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

}  // namespace labeled_cloud
