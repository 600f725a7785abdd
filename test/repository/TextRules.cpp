#include "TextRules.h"

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
