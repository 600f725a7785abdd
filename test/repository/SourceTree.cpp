#include "SourceTree.h"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace fs = std::filesystem;

namespace {

bool isText(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return std::find(std::istreambuf_iterator<char>(in), {}, '\0') ==
         std::istreambuf_iterator<char>();
}

}  // namespace

std::vector<fs::path> textFiles(const fs::path& root) {
  if (fs::is_regular_file(root)) return isText(root) ? std::vector{root} : std::vector<fs::path>();
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(root))
    if (entry.is_regular_file() && isText(entry.path())) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<SourceLine> linesOf(const fs::path& file) {
  std::ifstream in(file);
  std::vector<SourceLine> lines;
  for (std::string text; std::getline(in, text);) lines.push_back({file, lines.size() + 1, text});
  return lines;
}

std::string textOf(const fs::path& file) {
  std::string text;
  for (const SourceLine& line : linesOf(file)) text += line.text + "\n";
  return text;
}

std::vector<SourceLine> linesOfSources(const fs::path& root) {
  std::vector<SourceLine> all;
  for (const fs::path& file : textFiles(root)) {
    if (!isCppFile(file)) continue;
    const auto lines = linesOf(file);
    all.insert(all.end(), lines.begin(), lines.end());
  }
  return all;
}

bool isCppFile(const fs::path& file) {
  return file.extension() == ".h" || file.extension() == ".cpp";
}
