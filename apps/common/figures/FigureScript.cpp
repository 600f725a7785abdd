#include "FigureScript.h"

#include <strict_files/TextFile.h>
#include <strict_files/Words.h>
#include <sys/wait.h>

#include <cctype>
#include <csignal>
#include <cstdio>
#include <stdexcept>

namespace figures {
namespace {

// In single quotes, some texts with quotes of their own end the string (gnuplot 5.4). A digit would
// belong to the number before it.
std::string quoted(const std::string& bytes) {
  std::string result = "\"";
  for (const unsigned char c : bytes) {
    char octal[5] = {static_cast<char>(c), '\0'};
    const bool isPlain = c == ' ' || (c < 0x80 && std::isalpha(c));
    if (!isPlain) std::snprintf(octal, sizeof octal, "\\%03o", c);
    result += octal;
  }
  return result + '"';
}

/** Lets gnuplot, without its user's settings, read a script. \return what is wrong */
std::string draw(const std::string& script) {
  constexpr int kNotInstalled = 127;
  std::FILE* const gnuplot =
      popen("command -v gnuplot >/dev/null || exit 127; exec gnuplot -d", "we");
  if (!gnuplot) return "gnuplot cannot be started";
  const auto previous = std::signal(SIGPIPE, SIG_IGN);  // it may be gone before it has read
  std::fputs(script.c_str(), gnuplot);
  const int status = pclose(gnuplot);
  std::signal(SIGPIPE, previous);
  if (WIFEXITED(status) && WEXITSTATUS(status) == kNotInstalled)
    return "gnuplot is not installed (Debian's package gnuplot-nox)";
  return status == 0 ? "" : "gnuplot could not draw";
}

bool isWholePng(const std::filesystem::path& file) {
  static const std::string end("IEND\xae\x42\x60\x82");
  const std::string content = strict_files::readText(file);
  return content.size() > end.size() &&
         content.compare(content.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

// As absolute paths, names are neither pipes nor options.
void drawWithGnuplot(const std::string& script, const std::filesystem::path& file) {
  std::string problem =
      draw("set output " + quoted(std::filesystem::absolute(file).string()) + '\n' + script);
  if (problem.empty() && file.extension() == ".png" && !isWholePng(file))
    problem = file.filename().string() +
              ": cannot be written: is the disk full?";  // gnuplot does not look
  if (problem.empty()) return;
  std::error_code error;
  std::filesystem::remove(file, error);
  throw std::runtime_error(problem);
}

std::string gnuplotText(const std::string& text) { return quoted(strict_files::printable(text)); }

std::string ticText(const std::string& text) {
  std::string format;
  for (const char c : text) format += c == '%' ? std::string("%%") : std::string(1, c);
  return gnuplotText(format);
}

// The colors of M. Okabe and K. Ito ("Color Universal Design", 2008), which the color-blind tell
// apart, in an order in which the first five differ most for them; used again from the first one
// on. A curve shows through the dashes of one upon it.
std::ostringstream scriptFor(std::size_t width, std::size_t height) {
  std::ostringstream out;
  out << "set terminal pngcairo noenhanced size " << width << ',' << height
      << " font 'DejaVu Sans,11' background '#ffffff'\n"
      << "set border 3 lc rgb '#808080'\n"
      << "set tics nomirror out scale 0.5 textcolor rgb '#303030'\n"
      << "set grid ytics lc rgb '#d8d8d8' lt 1\n"
      << "set linetype cycle 8\n"
      << "set linetype 1 lc rgb '#0072b2' dt 1 pt 7\n"
      << "set linetype 2 lc rgb '#e69f00' dt (14,5) pt 5\n"
      << "set linetype 3 lc rgb '#009e73' dt (3,3) pt 9\n"
      << "set linetype 4 lc rgb '#000000' dt (14,4,3,4) pt 13\n"
      << "set linetype 5 lc rgb '#56b4e9' dt (7,3) pt 11\n"
      << "set linetype 6 lc rgb '#d55e00' dt 1 pt 7\n"
      << "set linetype 7 lc rgb '#cc79a7' dt (14,5) pt 5\n"
      << "set linetype 8 lc rgb '#f0e442' dt (3,3) pt 9\n";
  return out;
}

std::string styleOf(std::size_t solution) { return " lt " + std::to_string(solution + 1); }

}  // namespace figures
