#include "StandardOutput.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>

namespace {

bool quiet = false, verbose = false;

std::ostream& nowhere() {
  static std::ostream stream(nullptr);
  return stream;
}

}  // namespace

std::ostream& notes() { return quiet ? nowhere() : std::cout; }
std::ostream& details() { return verbose && !quiet ? std::cout : nowhere(); }
void beQuiet() { quiet = true; }
void beVerbose() { verbose = true; }

void openStandardStreams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(descriptor, F_GETFD) == -1)  // open() gives the lowest that is free
      (void)!open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

bool flushStandardOutput() {
  std::cout.flush();
  return std::fflush(stdout) == 0 && std::cout.good();
}
