#include "ErrorTexts.h"

#include <algorithm>
#include <regex>

#include "SourceTree.h"

namespace fs = std::filesystem;

namespace {

/** A source with blanks where it has comments. */
std::string withoutComments(std::string code) {
  static const std::regex parts(
      R"re("(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)+'|//[^\n]*|/\*[^]*?\*/)re");
  for (std::sregex_iterator it(code.begin(), code.end(), parts), end; it != end;) {
    const auto at = static_cast<std::size_t>(it->position()),
               length = static_cast<std::size_t>(it->length());
    const bool isComment = code[at] == '/';
    ++it;
    if (!isComment) continue;
    for (std::size_t i = at; i < at + length; ++i)
      if (code[i] != '\n') code[i] = ' ';
  }
  return code;
}

/** Where the literal that begins at a quotation mark ends, behind its second one. */
std::size_t endOfLiteral(const std::string& code, std::size_t begin) {
  std::size_t end = begin + 1;
  while (end < code.size() && code[end] != code[begin]) end += code[end] == '\\' ? 2 : 1;
  return std::min(end + 1, code.size());
}

/** The literals up to the end of a statement; those that follow each other are one. */
std::string textFrom(const std::string& code, std::size_t begin) {
  std::string text;
  bool gap = false;
  for (std::size_t i = begin; i < code.size() && code[i] != ';';) {
    const bool isQuote = code[i] == '"' || (code[i] == '\'' &&
                                            !std::isalnum(static_cast<unsigned char>(code[i - 1])));
    const std::size_t end = isQuote ? endOfLiteral(code, i) : i + 1;
    if (code[i] == '"') {
      if (gap && !text.empty()) text += kGap;
      text += code.substr(i + 1, end - i - 2);
      gap = false;
    } else if (!std::isspace(static_cast<unsigned char>(code[i]))) {
      gap = true;
    }
    i = end;
  }
  return std::regex_replace(text, std::regex(R"re(\\(["\\]))re"), "$1");
}

}  // namespace

std::vector<ErrorText> errorTextsOf(const fs::path& source) {
  static const std::regex sayings(
      R"re(\bthrow\b(?! std::(?:bad_alloc|filesystem))|\b(?:fail|refuse|complain)\w*\((?=[^)])|\bValidationError\(|\bstd::cerr\b)re");
  static const std::regex word("[A-Za-z]{4}"), definition(R"(^\w+\([^;]*?\)( const)? *(try *)?\{)");
  static const std::regex ofAKind(R"re(unknownWord\("[a-z]*")re");
  const std::string code =
      std::regex_replace(withoutComments(textOf(source)), ofAKind, "unknownWord(0");
  std::vector<ErrorText> texts;
  for (std::sregex_iterator it(code.begin(), code.end(), sayings), end; it != end; ++it) {
    const auto at = static_cast<std::size_t>(it->position());
    const std::string statement = code.substr(at, code.find(';', at) - at);
    if (std::regex_search(statement, definition)) continue;
    const std::string text = textFrom(code, at);
    const auto line =
        static_cast<std::size_t>(std::count(code.begin(), code.begin() + it->position(), '\n'));
    if (std::regex_search(text, word)) texts.push_back({source, line + 1, text});
  }
  return texts;
}
