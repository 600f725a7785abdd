#include "MessageRules.h"

#include <algorithm>
#include <regex>

#include "SourceTree.h"

namespace fs = std::filesystem;

namespace {

std::vector<std::string> allMatches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::string> matches;
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it)
    matches.push_back((*it)[1]);
  return matches;
}

/** The texts in a source; those that are only parted by the end of a line are one. */
std::vector<std::string> literalsOf(const fs::path& source) {
  const std::string joined =
      std::regex_replace(textOf(source), std::regex(R"re("\s*\n\s*")re"), "");
  std::vector<std::string> literals;
  for (const std::string& line : allMatches(joined, R"re("((?:[^"\\\n]|\\.)*)")re"))
    literals.push_back(std::regex_replace(line, std::regex(R"re(\\")re"), "\""));
  return literals;
}

/** What stays the same in a message. */
std::vector<std::string> fixedParts(const std::string& message) {
  static const std::regex changing(R"(FILE|NAME|\.\.\.|\b[A-Z]\b|[0-9]+|')");
  std::vector<std::string> parts;
  std::sregex_token_iterator it(message.begin(), message.end(), changing, -1), end;
  for (; it != end; ++it) {
    const std::string part =
        std::regex_replace(it->str(), std::regex(R"(^[ :;,()\[\]=]+|[ :;,()\[\]=]+$)"), "");
    if (part.size() > 2) parts.push_back(part);
  }
  return parts;
}

bool isSaid(const std::string& part, const std::vector<std::string>& literals) {
  const auto any = [&](const auto& holds) {
    return std::any_of(literals.begin(), literals.end(), holds);
  };
  if (any([&](const std::string& l) { return l.find(part) != std::string::npos; })) return true;
  for (std::size_t split = 3; split + 3 <= part.size(); ++split) {
    const std::string left = part.substr(0, split), right = part.substr(split);
    if (any([&](const std::string& l) {
          return l.size() >= split && l.compare(l.size() - split, split, left) == 0;
        }) &&
        any([&](const std::string& l) { return l.rfind(right, 0) == 0; }))
      return true;
  }
  return false;
}

struct Entry {
  SourceLine line;
  std::string message;
};

/** In the first column of its tables. */
std::vector<Entry> entriesOf(const fs::path& markdownFile) {
  std::vector<Entry> entries;
  for (const SourceLine& line : linesOf(markdownFile)) {
    if (line.text.rfind("| ", 0) != 0) continue;
    for (const std::string& message :
         allMatches(line.text.substr(0, line.text.find(" | ", 1)), "`([^`]*)`"))
      entries.push_back({line, message});
  }
  return entries;
}

}  // namespace

std::vector<std::string> messagesNobodySays(const fs::path& markdownFile,
                                            const std::vector<fs::path>& sources) {
  std::vector<std::string> literals, findings;
  for (const fs::path& folder : sources)
    for (const fs::path& file : textFiles(folder)) {
      const auto more = isCppFile(file) ? literalsOf(file) : std::vector<std::string>();
      literals.insert(literals.end(), more.begin(), more.end());
    }
  for (const Entry& entry : entriesOf(markdownFile))
    for (const std::string& part : fixedParts(entry.message))
      if (!isSaid(part, literals))
        findings.push_back(entry.line.where(markdownFile.parent_path()) + ": " + part);
  return findings;
}
