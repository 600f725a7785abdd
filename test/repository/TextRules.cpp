#include "TextRules.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <regex>
#include <sstream>
#include <stdexcept>

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

namespace {

/** Splits a Markdown text into paragraphs, list items and cells of tables. */
class Paragraphs {
 public:
  explicit Paragraphs(const std::string& markdown) {
    std::istringstream lines(markdown);
    for (std::string line; std::getline(lines, line);) add(line);
    end();
  }
  const std::vector<std::string>& all() const { return m_all; }

 private:
  std::vector<std::string> m_all;
  std::string m_current;
  bool m_fenced = false;

  void end() {
    if (!m_current.empty()) m_all.push_back(m_current);
    m_current.clear();
  }

  void addRow(const std::string& line) {
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, '|');) m_all.push_back(cell);
  }

  void add(const std::string& line) {
    static const std::regex item(R"(^\s*([-*]|\d+\.) )");
    const bool fence = line.rfind("```", 0) == 0, table = line.rfind('|', 0) == 0;
    const bool code = m_current.empty() && line.rfind("    ", 0) == 0;
    if (fence) m_fenced = !m_fenced;
    if (m_fenced || fence || code || table || line.empty() || line.front() == '#') {
      end();
      if (table && !m_fenced) addRow(line);
      return;
    }
    if (std::regex_search(line, item)) end();
    m_current += std::regex_replace(line, item, "") + " ";
  }
};

std::string withoutMarkup(std::string text) {
  text = std::regex_replace(text, std::regex(R"(!?\[([^\]]*)\]\([^)]*\))"), "$1");
  return std::regex_replace(text, std::regex("`[^`]*`"), "Code");
}

}  // namespace

std::size_t countWords(const std::string& text) {
  std::istringstream words(text);
  std::size_t count = 0;
  for (std::string word; words >> word;)
    count += std::any_of(word.begin(), word.end(), [](unsigned char c) { return std::isalnum(c); });
  return count;
}

std::vector<std::string> sentencesOf(const std::string& markdown) {
  static const std::regex end(R"([.?!]["*)]*\s+(?=["(*A-Z0-9]))");
  const Paragraphs paragraphs(markdown);
  std::vector<std::string> sentences;
  for (const std::string& paragraph : paragraphs.all()) {
    const std::string text = withoutMarkup(paragraph);
    for (std::sregex_token_iterator it(text.begin(), text.end(), end, -1), last; it != last; ++it)
      if (countWords(*it) >= 4) sentences.push_back(*it);
  }
  return sentences;
}

std::size_t quantile(std::vector<std::size_t> numbers, double share) {
  if (numbers.empty()) throw std::invalid_argument("a quantile of no numbers");
  std::sort(numbers.begin(), numbers.end());
  const double rank = std::ceil(share * static_cast<double>(numbers.size()));
  return numbers[std::max<std::size_t>(1, static_cast<std::size_t>(rank)) - 1];
}

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
