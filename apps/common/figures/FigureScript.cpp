#include "FigureScript.h"

#include <array>

namespace figures {

// Told apart in print and by the color-blind; used again from the first one on.
const char* colorOf(std::size_t solution) {
  static const std::array<const char*, 8> colors = {"#3b6fb6", "#e08a2e", "#4a9c6d", "#b5483a",
                                                    "#8667ad", "#7a6a58", "#d17fb0", "#5fb0c4"};
  return colors[solution % colors.size()];
}

std::ostringstream scriptFor(const std::filesystem::path& file, std::size_t width,
                             std::size_t height) {
  std::ostringstream out;
  out << "set terminal pngcairo noenhanced size " << width << ',' << height
      << " font 'DejaVu Sans,11' background '#ffffff'\n"
      << "set output " << gnuplotText(file.string()) << '\n'
      << "set border 3 lc rgb '#808080'\n"
      << "set tics nomirror out scale 0.5 textcolor rgb '#303030'\n"
      << "set grid ytics lc rgb '#d8d8d8' lt 1\n";
  return out;
}

}  // namespace figures
