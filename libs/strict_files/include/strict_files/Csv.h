#pragma once
#include <string>
#include <vector>

namespace strict_files {

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

}  // namespace strict_files
