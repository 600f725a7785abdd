#pragma once
#include <string>
#include <vector>

/** The fields of each record of a CSV text (RFC 4180) whose records end with "\n". */
inline std::vector<std::vector<std::string>> csvTable(const std::string& text) {
  std::vector<std::vector<std::string>> table(1, std::vector<std::string>(1));
  bool inQuotes = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' && inQuotes && i + 1 < text.size() && text[i + 1] == '"')
      table.back().back() += text[++i];
    else if (c == '"')
      inQuotes = !inQuotes;
    else if (c == ',' && !inQuotes)
      table.back().emplace_back();
    else if (c == '\n' && !inQuotes)
      table.emplace_back(1);
    else
      table.back().back() += c;
  }
  if (table.back().size() == 1 && table.back()[0].empty()) table.pop_back();  // behind the last end
  return table;
}
