#include "TextRules.h"

#include <algorithm>
#include <regex>

#include "SourceTree.h"

namespace fs = std::filesystem;

namespace {

std::vector<std::string> linesThatMatch(const std::regex& pattern, const std::string& problem,
                                        const fs::path& root) {
  std::vector<std::string> findings;
  for (const fs::path& file : textFiles(root))
    for (const SourceLine& line : linesOf(file))
      if (std::regex_search(line.text, pattern))
        findings.push_back(line.where(root) + ": " + problem);
  return findings;
}

}  // namespace

std::vector<std::string> linesWithTrailingSpace(const fs::path& root) {
  static const std::regex pattern(R"([ \t\r]$)");
  return linesThatMatch(pattern, "space at the end of the line", root);
}

std::vector<std::string> linesWithCarriageReturn(const fs::path& root) {
  static const std::regex pattern(R"(\r)");
  return linesThatMatch(pattern, "a carriage return", root);
}

std::vector<std::string> linesTiedToAMachine(const fs::path& root) {
  static const std::regex pattern(
      R"((^|[^\w.}])/(work|home|root|tmp|Users|mnt)/|(deb|ftp|security|archive)\.(debian|ubuntu)\.)");
  return linesThatMatch(pattern, "a path or a server of one machine", root);
}

std::vector<std::string> borrowedSources(const fs::path& root) {
  static const std::regex pattern(
      R"re(^\s*(#\s*include\s*")?(\.\./)+(apps|[\w-]+-[\w-]+)/[^ ]*\.(h|cpp)"?$)re");
  return linesThatMatch(pattern, "a source of another program", root);
}

std::vector<std::string> optionNamesWithSpaces(const fs::path& root) {
  static const std::regex pattern(
      R"(add_(option|flag)(_function|_callback)?(<[^(]*>)?\(\s*"[^"]*\s[^"]*")");
  std::vector<std::string> findings;
  for (const fs::path& file : textFiles(root)) {
    const std::string text = isCppFile(file) ? textOf(file) : "";
    for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it)
      findings.push_back(file.lexically_relative(root).string() + ":" +
                         std::to_string(1 + std::count(text.begin(), (*it)[0].first, '\n')) +
                         ": a name with spaces");
  }
  return findings;
}

std::vector<std::string> filesLongerThan(std::size_t maxLines, const fs::path& root) {
  std::vector<std::string> findings;
  for (const fs::path& file : textFiles(root)) {
    const std::size_t count = isCppFile(file) ? linesOf(file).size() : 0;
    if (count <= maxLines) continue;
    findings.push_back(file.lexically_relative(root).string() + ":" + std::to_string(count) +
                       ": more than " + std::to_string(maxLines) + " lines");
  }
  return findings;
}

namespace {

/** Without blanks at the ends of lines, so that an excerpt may be indented otherwise. */
std::string withoutIndents(const std::string& text) {
  return std::regex_replace(text, std::regex(R"(\s*\n\s*)"), "\n");
}

/** A block of C++ or Python in a document, below a line that links to a source. */
struct Excerpt {
  std::size_t line;
  std::string source, text;
};

std::vector<Excerpt> excerptsOf(const fs::path& markdownFile) {
  static const std::regex link(R"(\]\(([^)]*\.(?:cpp|py))\))");
  std::vector<Excerpt> excerpts;
  std::string source;
  bool inside = false;
  for (const SourceLine& line : linesOf(markdownFile)) {
    std::smatch match;
    if (line.text.rfind("```", 0) == 0) {
      inside = (line.text == "```cpp" || line.text == "```python") && !source.empty();
      if (inside) excerpts.push_back({line.number, source, "\n"});
      source.clear();
    } else if (inside) {
      excerpts.back().text += line.text + "\n";
    } else if (!line.text.empty()) {
      source = std::regex_search(line.text, match, link) ? match[1].str() : "";
    }
  }
  return excerpts;
}

}  // namespace

std::vector<std::string> excerptsThatDiffer(const fs::path& markdownFile) {
  std::vector<std::string> findings;
  const fs::path folder = markdownFile.parent_path();
  for (const Excerpt& excerpt : excerptsOf(markdownFile)) {
    const std::string source = withoutIndents("\n" + textOf(folder / excerpt.source));
    if (source.find(withoutIndents(excerpt.text)) == std::string::npos)
      findings.push_back(markdownFile.filename().string() + ":" + std::to_string(excerpt.line) +
                         ": " + excerpt.source + " does not have these lines");
  }
  return findings;
}

std::string firstComment(const fs::path& cmakeFile) {
  std::string comment;
  for (const SourceLine& line : linesOf(cmakeFile)) {
    if (line.text.rfind("# ", 0) != 0) break;
    comment += (comment.empty() ? "" : " ") + line.text.substr(2);
  }
  return comment;
}

std::vector<std::string> brokenLinks(const fs::path& markdownFile) {
  static const std::regex link(R"(\]\(([^):#]+)[^):]*\))");
  std::vector<std::string> findings;
  const fs::path folder = markdownFile.parent_path();
  for (const SourceLine& line : linesOf(markdownFile)) {
    for (std::sregex_iterator it(line.text.begin(), line.text.end(), link), end; it != end; ++it)
      if (!fs::exists(folder / (*it)[1].str()))
        findings.push_back(line.where(folder) + ": no file " + (*it)[1].str());
  }
  return findings;
}
