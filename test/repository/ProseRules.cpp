#include "ProseRules.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <regex>
#include <sstream>
#include <stdexcept>

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
