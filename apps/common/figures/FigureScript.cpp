#include "FigureScript.h"

#include <array>

namespace figures {

// The colors of M. Okabe and K. Ito ("Color Universal Design", 2008), which the color-blind tell
// apart, in an order in which the first five differ most for them; used again from the first one
// on.
const char* colorOf(std::size_t solution) {
  static const std::array<const char*, 8> colors = {"#0072b2", "#e69f00", "#009e73", "#000000",
                                                    "#56b4e9", "#d55e00", "#cc79a7", "#f0e442"};
  return colors[solution % colors.size()];
}

const char* dashOf(std::size_t solution) {
  static const std::array<const char*, 5> dashes = {"1", "(14,5)", "(3,3)", "(14,4,3,4)", "(7,3)"};
  return dashes[solution % dashes.size()];
}

int pointOf(std::size_t solution) {
  static const std::array<int, 5> points = {7, 5, 9, 13, 11};
  return points[solution % points.size()];
}

std::string styleOf(std::size_t solution) {
  return std::string("dt ") + dashOf(solution) + " pt " + std::to_string(pointOf(solution)) +
         " lc rgb '" + colorOf(solution) + "'";
}

std::ostringstream scriptFor(std::size_t width, std::size_t height) {
  std::ostringstream out;
  out << "set terminal pngcairo noenhanced size " << width << ',' << height
      << " font 'DejaVu Sans,11' background '#ffffff'\n"
      << "set border 3 lc rgb '#808080'\n"
      << "set tics nomirror out scale 0.5 textcolor rgb '#303030'\n"
      << "set grid ytics lc rgb '#d8d8d8' lt 1\n";
  return out;
}

std::string ticText(const std::string& text) {
  std::string format;
  for (const char c : text) format += c == '%' ? std::string("%%") : std::string(1, c);
  return gnuplotText(format);
}

}  // namespace figures
