#pragma once
#include <filesystem>
#include <sstream>
#include <string>

namespace figures {

/** Draws a script with gnuplot into a file. \throw std::runtime_error gnuplot is not installed, or
 * could not draw it; there is no file then. */
void drawWithGnuplot(const std::string& script, const std::filesystem::path& file);

/** A text as gnuplot's scripts have it: drawn as it is, but for what printable() writes otherwise.
 * gnuplot takes no part of it for a command, a macro or a shell's command. Bytes other than
 * letters and spaces are written as their numbers. */
std::string gnuplotText(const std::string& text);

/** A text as gnuplot's tics have it, which are formats of the number that they stand at. */
std::string ticText(const std::string& text);

/** Beginning of a script that draws a picture (PNG) of that size, pixels. */
std::ostringstream scriptFor(std::size_t width, std::size_t height);

/** A solution's color, dashes and points, the same in all figures that scriptFor() begins. */
std::string styleOf(std::size_t solution);

/** Names at 0, 1, 2... of an axis. */
template <typename Names>
std::string tics(std::size_t count, const Names& name) {
  std::string text = "(";
  for (std::size_t i = 0; i < count; ++i)
    text += (i ? ", " : "") + ticText(name(i)) + " " + std::to_string(i);
  return text + ")";
}

}  // namespace figures
