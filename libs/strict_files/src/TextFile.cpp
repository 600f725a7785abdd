#include <strict_files/OptionList.h>
#include <strict_files/OutputFiles.h>
#include <strict_files/TextFile.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace strict_files {

std::string readText(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file))  // a folder can be opened, but not read
    throw std::runtime_error(file.string() + ": cannot be read");
  return {std::istreambuf_iterator<char>(stream), {}};
}

void writeText(const std::filesystem::path& file, const std::string& text) {
  StagedFile staged(file);
  std::ofstream stream(staged.path(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw std::runtime_error(file.string() + ": cannot be written");
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
