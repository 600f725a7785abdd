#pragma once
#include <filesystem>
#include <ios>
#include <locale>
#include <string>
#include <vector>

namespace strict_files {

/** All of a text file, byte for byte.
 * \throw std::runtime_error naming the file: it cannot be read, is a pipe, or exceeds memory. */
std::string readText(const std::filesystem::path& file);

/** Writes it as a StagedFile: what was there stays unless all of the text could be written.
 * \throw std::runtime_error naming the file, if not. */
void writeText(const std::filesystem::path& file, const std::string& text);

/** A line of a text file, for messages that name it. */
struct TextLine {
  std::string text;
  /** "file:number" */
  std::string where;
};

/** The lines of a file, without comments ('#' and behind it), empty ones and line ends.
 * \throw std::runtime_error naming the file, if it cannot be read. */
std::vector<TextLine> readLines(const std::filesystem::path& file);

/** The lines of a text, as readLines() has them. \param name what TextLine::where calls it */
std::vector<TextLine> linesOf(const std::string& text, const std::string& name);

/** The numbers of a line, COUNT of them; what stands before the first is skipped if it ends with
 * ':'. \throw std::runtime_error naming file and line: fewer or more, not finite, or no numbers. */
std::vector<double> numbersOf(const TextLine& line, std::size_t count);

/** A text as a field of a CSV file (RFC 4180): what has commas, quotes or line ends stands in
 * quotes, of which those inside are doubled. Bytes above 127 stay as they are. */
inline std::string csvField(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? "\"\"" : std::string(1, c);
  return field + '"';
}

/** The fields of a line without line ends in them. */
inline std::vector<std::string> csvFieldsOf(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool doubled = quoted && line.compare(i, 2, "\"\"") == 0;
    if (line[i] == '"' && !doubled)
      quoted = !quoted;
    else if (line[i] == ',' && !quoted)
      fields.emplace_back();
    else
      fields.back() += line[i];
    i += doubled;
  }
  return fields;
}

/** While one lives, a stream writes and reads numbers as files have them ("0.5", "1000"). The
 * program's std::locale::global() may have decimal commas and group digits. */
class ClassicNumbers {
 public:
  explicit ClassicNumbers(std::ios& stream)
      : m_stream(stream), m_before(stream.imbue(std::locale::classic())) {}
  ~ClassicNumbers() { m_stream.imbue(m_before); }
  ClassicNumbers(const ClassicNumbers&) = delete;
  ClassicNumbers& operator=(const ClassicNumbers&) = delete;

 private:
  std::ios& m_stream;
  std::locale m_before;
};

}  // namespace strict_files
