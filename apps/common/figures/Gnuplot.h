#pragma once
#include <filesystem>
#include <string>

namespace figures {

/** Draws a script with gnuplot, whose standard output becomes the file: no name of a file is part
 * of a script. \throw std::runtime_error gnuplot is not installed, or could not draw it; there is
 * no file then. */
void drawWithGnuplot(const std::string& script, const std::filesystem::path& file);

/** A text as gnuplot's scripts have it: drawn as it is, but for what printable() writes otherwise.
 * gnuplot takes no part of it for a command, a macro or a shell's command: but for letters, digits
 * and spaces, bytes are written as their numbers. */
std::string gnuplotText(const std::string& text);

}  // namespace figures
