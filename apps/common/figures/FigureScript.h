#pragma once
#include <sstream>
#include <string>

#include "Gnuplot.h"

namespace figures {

/** A solution's color, the same in all figures. */
const char* colorOf(std::size_t solution);

/** Its line's dashes, as gnuplot's `dashtype` has them: a curve shows through one upon it. */
const char* dashOf(std::size_t solution);

/** Its points, as gnuplot's `pointtype` has them: filled shapes. */
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
