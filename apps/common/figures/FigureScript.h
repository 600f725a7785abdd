#pragma once
#include <filesystem>
#include <sstream>
#include <string>

namespace figures {

/** Draws a script with gnuplot, whose standard output becomes the file: no name of a file is part
 * of a script. \throw std::runtime_error gnuplot is not installed, or could not draw it; there is
 * no file then. */
void drawWithGnuplot(const std::string& script, const std::filesystem::path& file);

/** A text as gnuplot's scripts have it: drawn as it is, but for what printable() writes otherwise.
 * gnuplot takes no part of it for a command, a macro or a shell's command. Bytes other than
 * letters, digits and spaces are written as their numbers. */
std::string gnuplotText(const std::string& text);

/** A solution's color, the same in all figures. */
const char* colorOf(std::size_t solution);

/** Dashes of a solution's line, as gnuplot's `dashtype` has them: a curve shows through one upon
 * it. */
const char* dashOf(std::size_t solution);

/** Points of a solution, as gnuplot's `pointtype` has them: filled shapes. */
int pointOf(std::size_t solution);

/** How a solution is drawn "with linespoints": dashes, points and color. */
std::string styleOf(std::size_t solution);

/** Beginning of a script that draws a picture (PNG) of that size, pixels. */
std::ostringstream scriptFor(std::size_t width, std::size_t height);

/** A text as gnuplot's tics have it, which are formats of the number that they stand at. */
std::string ticText(const std::string& text);

/** Names at 0, 1, 2... of an axis. */
template <typename Names>
std::string tics(std::size_t count, const Names& name) {
  std::string text = "(";
  for (std::size_t i = 0; i < count; ++i)
    text += (i ? ", " : "") + ticText(name(i)) + " " + std::to_string(i);
  return text + ")";
}

}  // namespace figures
