#pragma once
#include <string>

namespace figures {

/** Draws a script with gnuplot, through a pipe.
 * \throw std::runtime_error gnuplot is not installed, or could not draw it. */
void drawWithGnuplot(const std::string& script);

/** A text as gnuplot's scripts have it. */
std::string gnuplotText(const std::string& text);

}  // namespace figures
