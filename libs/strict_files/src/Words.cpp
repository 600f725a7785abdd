#include <strict_files/Words.h>

#include <algorithm>
#include <cctype>
#include <numeric>
#include <utility>

namespace strict_files {

namespace {

std::string folded(const std::string& word) {
  std::string result;
  for (const char c : word)
    if (c != '_' && c != '-')
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

/** Letters to insert, remove or replace (Levenshtein). */
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] != b[j]);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

bool sameWord(const std::string& a, const std::string& b) { return folded(a) == folded(b); }

std::string unknownWord(const std::string& kind, const std::string& word,
                        const std::vector<std::string>& known) {
  const std::string* nearest = nullptr;
  std::size_t least = 1 + word.size() / 2;  // farther is another word
  for (const std::string& candidate : known) {
    const std::size_t distance = editDistance(folded(word), folded(candidate));
    if (distance >= least) continue;
    least = distance;
    nearest = &candidate;
  }
  const std::string beginning = "unknown " + kind + " '" + word + "'; ";
  if (nearest) return beginning + "did you mean '" + *nearest + "'?";
  return beginning + (known.empty() ? "none is known" : "known are " + joined(known));
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

std::string joined(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  return list;
}

}  // namespace strict_files
