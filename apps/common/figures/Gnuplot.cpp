#include "Gnuplot.h"

#include <sys/wait.h>

#include <csignal>
#include <cstdio>
#include <stdexcept>

namespace figures {

void drawWithGnuplot(const std::string& script) {
  constexpr int kNotFound = 127;                        // as the shell has it
  const auto previous = std::signal(SIGPIPE, SIG_IGN);  // gnuplot may be gone before it has read
  std::FILE* pipe = popen("command -v gnuplot > /dev/null || exit 127; exec gnuplot", "w");
  if (!pipe) throw std::runtime_error("gnuplot cannot be started");
  std::fputs(script.c_str(), pipe);
  const int status = pclose(pipe);
  std::signal(SIGPIPE, previous);
  if (WIFEXITED(status) && WEXITSTATUS(status) == kNotFound)
    throw std::runtime_error("gnuplot is not installed (Debian's package gnuplot-nox)");
  if (status != 0) throw std::runtime_error("gnuplot could not draw");
}

std::string gnuplotText(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

}  // namespace figures
