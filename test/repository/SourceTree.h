#pragma once
#include <filesystem>
#include <string>
#include <vector>

struct SourceLine {
  std::filesystem::path file;
  std::size_t number;  ///< From 1.
  std::string text;

  /** "path:number", the path relative to a folder. */
  std::string where(const std::filesystem::path& base) const {
    return file.lexically_relative(base).string() + ":" + std::to_string(number);
  }
};

/** All text files below a folder, or the file itself, in a fixed order. Files with a zero byte are
 * not text. */
std::vector<std::filesystem::path> textFiles(const std::filesystem::path& root);

/** The lines of a text file, without their ends. */
std::vector<SourceLine> linesOf(const std::filesystem::path& file);

/** A text file as one string; each line ends. */
std::string textOf(const std::filesystem::path& file);

/** The lines of all C++ files below a folder. */
std::vector<SourceLine> linesOfSources(const std::filesystem::path& root);

bool isCppFile(const std::filesystem::path& file);
