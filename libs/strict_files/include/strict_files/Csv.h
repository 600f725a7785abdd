#pragma once
#include <string>

namespace strict_files {

/** A text as a field of a CSV file (RFC 4180): what has commas, quotes or line ends stands in
 * quotes, of which those inside are doubled. Bytes above 127 stay as they are. */
inline std::string csvField(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? "\"\"" : std::string(1, c);
  return field + '"';
}

}  // namespace strict_files
