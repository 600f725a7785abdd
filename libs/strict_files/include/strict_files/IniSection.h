#pragma once
#include <strict_files/OptionList.h>
#include <strict_files/TextFile.h>
#include <strict_files/Words.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace strict_files {

/** Reads a section of an .ini file into options, strictly: MRPT ignores unknown keys. Call read()
 * or text() for what is known, then finish(). Keys that are absent leave their option as it is. */
class IniSection {
 public:
  /** \param source An mrpt::config::CConfigFileBase, or what has its getAllKeys() and
   * read_string(). */
  template <class Source>
  IniSection(const Source& source, std::string section) : m_section(std::move(section)) {
    std::vector<std::string> keys;
    source.getAllKeys(m_section, keys);
    for (const std::string& key : keys)
      m_entries.emplace_back(key, source.read_string(m_section, key, ""));
  }

  /** The value without a comment behind it, which MRPT leaves there; nothing if the key is absent.
   */
  std::optional<std::string> text(const std::string& key);

  /** Reads all options that are there. \throw std::runtime_error naming section, key and value: not
   * what the option may be. */
  void read(const OptionList& list);

  /** \throw std::runtime_error naming the section. */
  [[noreturn]] void fail(const std::string& what) const;
  /** \throw std::runtime_error naming section and key, and the nearest known one: a key that was
   * not read. */
  void finish() const;

 private:
  std::string m_section;
  std::vector<std::pair<std::string, std::string>> m_entries;  ///< keys, and what is behind "="
  std::vector<std::string> m_known;
};

/** Reads a section that holds these options and nothing else.
 * \param source as for IniSection
 * \throw std::runtime_error naming section, key and value. */
template <class Source>
IniSection readOptions(const Source& source, const std::string& section, const OptionList& list) {
  IniSection ini(source, section);
  ini.read(list);
  ini.finish();
  return ini;
}

/** Reads a section into the options of a struct, and checks them. */
template <class Source, class Options>
void readSection(const Source& source, const std::string& section, Options& options) {
  const IniSection ini = readOptions(source, section, OptionList::of(options));
  try {
    options.validate();
  } catch (const std::invalid_argument& e) {
    ini.fail(e.what());
  }
}

/** What MRPT's reader leaves out without a word. \param text all of the file
 * \throw std::runtime_error naming the line: it is no section, no "key = value", no comment, or a
 * key that its section has already. */
void checkIniText(const std::string& text);

/** \throw std::runtime_error naming the section and the nearest known one: it is none of these.
 * \param known "camera *" stands for all that begin with "camera " */
void checkSection(const std::string& section, const std::vector<std::string>& known);

/** Checks the names of all sections of a file that have a key. */
template <class Source>
void checkSections(const Source& source, const std::vector<std::string>& known) {
  std::vector<std::string> sections, keys;
  source.getAllSections(sections);
  for (const std::string& section : sections) {
    source.getAllKeys(section, keys);
    if (!section.empty() || !keys.empty()) checkSection(section, known);
  }
}

/** Reads an .ini file: \p read is called with it, as an Ini.
 * \tparam Ini mrpt::config::CConfigFileMemory: a file of a name that cannot be opened is empty to
 * MRPT \throw std::runtime_error naming the file: it cannot be read, or what \p read throws. */
template <class Ini, class Read>
void readIniFile(const std::filesystem::path& file, const Read& read) {
  const std::string text = readText(file);
  try {
    checkIniText(text);
    read(Ini(text));
  } catch (const std::exception& e) {
    throw std::runtime_error(file.string() + ": " + messageOf(e));
  }
}

}  // namespace strict_files
