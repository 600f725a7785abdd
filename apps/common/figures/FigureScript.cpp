#include "FigureScript.h"

#include <fcntl.h>
#include <spawn.h>
#include <strict_files/Words.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <stdexcept>

namespace figures {
namespace {

/** Starts gnuplot without its user's settings. \return what posix_spawnp() does */
int start(int input, int output, pid_t& child) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  char name[] = "gnuplot", noSettings[] = "-d";
  char* const arguments[] = {name, noSettings, nullptr};
  const int error = posix_spawnp(&child, name, &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

void send(const std::string& script, int pipe) {
  const auto previous = std::signal(SIGPIPE, SIG_IGN);  // gnuplot may be gone before it has read
  std::FILE* stream = fdopen(pipe, "w");
  std::fputs(script.c_str(), stream);
  std::fclose(stream);
  std::signal(SIGPIPE, previous);
}

/** The exit status of a process that ends. */
int statusOf(pid_t child) {
  int status = -1;
  while (waitpid(child, &status, 0) == -1 && errno == EINTR) {
  }
  return status;
}

bool isWholePng(int file) {
  static const std::string end("IEND\xae\x42\x60\x82");
  std::string last(end.size(), '\0');
  const off_t size = lseek(file, 0, SEEK_END);
  return pread(file, &last[0], last.size(), size - static_cast<off_t>(last.size())) >= 0 &&
         last == end;
}

/** \return what is wrong */
std::string draw(const std::string& script, int output) {
  int ends[2] = {-1, -1};
  if (pipe2(ends, O_CLOEXEC) == -1) return "gnuplot cannot be started";
  pid_t child = 0;
  const int error = start(ends[0], output, child);
  close(ends[0]);
  send(error == 0 ? script : "", ends[1]);
  if (error == ENOENT) return "gnuplot is not installed (Debian's package gnuplot-nox)";
  if (error != 0) return "gnuplot cannot be started";
  return statusOf(child) == 0 ? "" : "gnuplot could not draw";
}

}  // namespace

void drawWithGnuplot(const std::string& script, const std::filesystem::path& file) {
  const int output = open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (output == -1) throw std::runtime_error(file.string() + ": cannot be written");
  std::string problem = draw(script, output);
  if (problem.empty() && file.extension() == ".png" && !isWholePng(output))
    problem = file.filename().string() +
              ": cannot be written: is the disk full?";  // gnuplot does not look
  close(output);
  if (problem.empty()) return;
  std::error_code error;
  std::filesystem::remove(file, error);
  throw std::runtime_error(problem);
}

// In single quotes, some texts with quotes of their own end the string (gnuplot 5.4).
std::string gnuplotText(const std::string& text) {
  std::string result = "\"";
  for (const unsigned char c : strict_files::printable(text)) {
    char octal[5] = {static_cast<char>(c), '\0'};
    const bool isPlain = c == ' ' || (c < 0x80 && std::isalnum(c));
    if (!isPlain) std::snprintf(octal, sizeof octal, "\\%03o", c);
    result += octal;
  }
  return result + '"';
}

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
