#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace strict_files {

/** All of a text file, byte for byte.
 * \throw std::runtime_error naming the file, if it cannot be read. */
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

/** The same of a text. \param name What to call it in TextLine::where. */
std::vector<TextLine> linesOf(const std::string& text, const std::string& name);

/** The numbers of a line, COUNT of them; what stands before the first is skipped if it ends with
 * ':'. \throw std::runtime_error naming file and line: fewer or more, not finite, or no numbers. */
std::vector<double> numbersOf(const TextLine& line, std::size_t count);

}  // namespace strict_files
