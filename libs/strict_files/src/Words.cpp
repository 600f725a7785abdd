#include <strict_files/Words.h>

#include <strict_files/Memory.h>
#include <strict_files/OptionList.h>
#include <strict_files/OutputFiles.h>
#include <strict_files/TextFile.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <numeric>
#include <sstream>
#include <stdexcept>
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

/** The known word that is meant by an unknown one, or null. */
const std::string* nearestOf(const std::string& word, const std::vector<std::string>& known) {
  const std::string* nearest = nullptr;
  std::size_t least = 1 + folded(word).size() / 2;  // farther is another word
  for (const std::string& candidate : known) {
    const std::size_t distance = editDistance(folded(word), folded(candidate));
    if (distance >= least) continue;
    least = distance;
    nearest = &candidate;
  }
  return nearest;
}

/** How many bytes follow the first of a letter in UTF-8; more than 3 if no letter begins with it.
 */
std::size_t continuationOf(unsigned char first) {
  if (first < 0x80) return 0;
  if (first < 0xc0 || first >= 0xf8) return 4;
  return first < 0xe0 ? 1 : first < 0xf0 ? 2 : 3;
}

/** Bytes of the UTF-8 letter that begins there; 0 if there is none, or a control character, or one
 * that ends a line or turns text around. */
std::size_t printableBytes(const std::string& text, std::size_t begin) {
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(text[begin + i]); };
  const std::size_t more = continuationOf(at(0));
  if (more > 3 || text.size() - begin <= more) return 0;
  char32_t letter = more == 0 ? at(0) : at(0) & (0x3f >> more);
  for (std::size_t k = 1; k <= more; ++k) {
    if ((at(k) & 0xc0) != 0x80) return 0;
    letter = letter << 6 | (at(k) & 0x3f);
  }
  static const char32_t least[] = {0x20, 0xa0, 0x800, 0x10000};  // without C0 and C1
  const auto isBetween = [letter](char32_t low, char32_t high) {
    return letter >= low && letter <= high;
  };
  const bool turnsText = isBetween(0x2028, 0x202e) || isBetween(0x2066, 0x2069);
  const bool isLetter = isBetween(least[more], 0x10ffff) && letter != 0x7f &&
                        !isBetween(0xd800, 0xdfff) && !turnsText;
  return isLetter ? 1 + more : 0;
}

}  // namespace

bool sameWord(const std::string& a, const std::string& b) { return folded(a) == folded(b); }

std::string didYouMean(const std::string& word, const std::vector<std::string>& known) {
  const std::string* nearest = nearestOf(word, known);
  return nearest ? "; did you mean '" + *nearest + "'?" : "";
}

std::string unknownWord(const std::string& kind, const std::string& word,
                        const std::vector<std::string>& known) {
  const std::string unknown = "unknown " + kind + " '" + word + "'";
  if (nearestOf(word, known)) return unknown + didYouMean(word, known);
  return unknown + (known.empty() ? "; none is known" : "; known are " + joined(known));
}

std::string printable(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t bytes = printableBytes(text, i);
    if (bytes > 0) {
      result.append(text, i, bytes);
    } else {
      char hex[5];
      std::snprintf(hex, sizeof hex, "\\x%02x", static_cast<unsigned char>(text[i]));
      result += hex;
    }
    i += bytes > 0 ? bytes : 1;
  }
  return result;
}

std::string sizeText(std::uint64_t bytes) {
  if (bytes < 1000) return std::to_string(bytes) + " bytes";
  static const char* const units[] = {"kB", "MB", "GB", "TB", "PB", "EB"};
  double size = static_cast<double>(bytes) / 1000;
  std::size_t unit = 0;
  for (; size >= 999.5; size /= 1000) ++unit;
  char text[32];
  std::snprintf(text, sizeof text, size < 9.95 ? "%.1f %s" : "%.0f %s", size, units[unit]);
  return text;
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

std::string readText(const std::filesystem::path& file) {
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error(file.string() + ": " + why);
  };
  std::error_code none;
  const auto kind = std::filesystem::status(file, none).type();
  if (kind == std::filesystem::file_type::fifo || kind == std::filesystem::file_type::character)
    refuse("it is no file, but a device or a pipe");  // which may have no end
  std::ifstream stream(file, std::ios::binary);
  if (!stream || kind != std::filesystem::file_type::regular) refuse("cannot be read");
  const std::uint64_t size = std::filesystem::file_size(file), left = availableMemory();
  if (size > left)
    refuse("needs " + sizeText(size) + " of memory, and " + sizeText(left) + " are left");
  std::string text(size, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(size));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

void writeText(const std::filesystem::path& file, const std::string& text) {
  StagedFile staged(file);
  errno = 0;
  std::ofstream stream(staged.path(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream)
    throw std::runtime_error(file.string() + ": cannot be written: " + std::strerror(errno));
  staged.commit();
}

std::vector<TextLine> readLines(const std::filesystem::path& file) {
  return linesOf(readText(file), file.string());
}

std::vector<TextLine> linesOf(const std::string& all, const std::string& name) {
  std::istringstream stream(all);
  std::vector<TextLine> lines;
  std::string text;
  for (int number = 1; std::getline(stream, text); ++number) {
    text.erase(std::min(text.find('#'), text.size()));
    text.erase(text.find_last_not_of(" \t\r") + 1);
    if (!text.empty()) lines.push_back({text, name + ":" + std::to_string(number)});
  }
  return lines;
}

std::vector<double> numbersOf(const TextLine& line, std::size_t count) {
  std::istringstream stream(line.text.substr(line.text.find(':') + 1));
  const std::string inLine = " in '" + line.text + "'";
  std::vector<double> numbers;
  for (std::string word; stream >> word;) {
    double number = NAN;
    try {
      number = numberOf(word, "a number");
    } catch (const std::invalid_argument&) {
    }
    if (!std::isfinite(number))
      throw std::runtime_error(line.where + ": expected a number, found '" + word + "'" + inLine);
    numbers.push_back(number);
  }
  if (numbers.size() != count)
    throw std::runtime_error(line.where + ": expected " + std::to_string(count) +
                             " numbers, found " + std::to_string(numbers.size()) + inLine);
  return numbers;
}

}  // namespace strict_files
