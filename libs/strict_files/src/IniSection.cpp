#include <strict_files/IniSection.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <stdexcept>

namespace strict_files {

namespace {

bool sameButCase(const std::string& a, const std::string& b) {
  const auto same = [](unsigned char x, unsigned char y) {
    return std::tolower(x) == std::tolower(y);
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

}  // namespace

std::optional<std::string> IniSection::text(const std::string& key) {
  m_known.push_back(key);
  for (const auto& [present, value] : m_entries) {
    if (!sameWord(present, key)) continue;
    const std::string line = " " + value;
    std::size_t end = line.size();
    for (const char* mark : {" //", " #", " ;", "\t//", "\t#", "\t;"})
      end = std::min(end, line.find(mark));
    return trimmed(line.substr(0, end));
  }
  return std::nullopt;
}

void IniSection::read(const OptionList& list) {
  for (const Option& option : list.options()) {
    const auto found = text(option.name);
    if (!found) continue;
    try {
      option.set(*found);
    } catch (const std::invalid_argument& e) {
      fail(option.name + " " + e.what());
    }
  }
}

void IniSection::fail(const std::string& what) const {
  throw std::runtime_error("[" + m_section + "] " + what);
}

void IniSection::finish() const {
  for (const auto& [key, value] : m_entries) {
    const auto same = [&key = key](const std::string& known) { return sameWord(known, key); };
    if (std::none_of(m_known.begin(), m_known.end(), same)) fail(unknownWord("key", key, m_known));
  }
}

void checkIniText(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> keys;
  bool continues = false;
  int number = 0;
  const auto refuse = [&](const std::string& what) {
    throw std::runtime_error("line " + std::to_string(number) + ": " + what);
  };
  for (std::string raw; ++number, std::getline(stream, raw);) {
    const std::string line = trimmed(raw);
    const bool isContinuation = continues;
    continues = !line.empty() && line.back() == '\\';
    const bool isComment = line.empty() || line[0] == '#' || line[0] == ';' || line[0] == '@' ||
                           line.compare(0, 2, "//") == 0;
    if (isContinuation || isComment) continue;
    if (line[0] == '[') {
      if (line.find(']') == std::string::npos) refuse("'" + line + "' has no ']'");
      keys.clear();
      continue;
    }
    const std::string key = trimmed(line.substr(0, line.find('=')));
    if (line.find('=') == std::string::npos || key.empty())
      refuse("'" + line + "', expected key = value");
    const auto same = [&key](const std::string& known) { return sameWord(known, key); };
    if (std::any_of(keys.begin(), keys.end(), same)) refuse("key '" + key + "' twice");
    keys.push_back(key);
  }
}

void checkSection(const std::string& section, const std::vector<std::string>& known) {
  for (const std::string& name : known) {
    const bool isPrefix = !name.empty() && name.back() == '*';
    const std::size_t length = isPrefix ? name.size() - 1 : std::max(name.size(), section.size());
    if (sameButCase(section.substr(0, length), name.substr(0, length))) return;
  }
  throw std::runtime_error("[" + section + "] " + unknownWord("section", section, known));
}

}  // namespace strict_files
