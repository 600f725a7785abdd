#include "ChildProcess.h"

#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>

namespace insertion_benchmark {
namespace {

std::string readAll(int descriptor) {
  std::string bytes;
  char buffer[4096];
  for (ssize_t n; (n = read(descriptor, buffer, sizeof(buffer))) > 0;)
    bytes.append(buffer, static_cast<std::size_t>(n));
  return bytes;
}

void writeAll(int descriptor, const void* from, std::size_t bytes) {
  const char* next = static_cast<const char*>(from);
  while (bytes > 0) {
    const ssize_t n = write(descriptor, next, bytes);
    if (n <= 0) return;
    next += n, bytes -= static_cast<std::size_t>(n);
  }
}

[[noreturn]] void beChild(int descriptor, const std::function<std::vector<double>()>& action) {
  int status = 0;
  try {
    const std::vector<double> numbers = action();
    writeAll(descriptor, numbers.data(), numbers.size() * sizeof(double));
  } catch (const std::exception& e) {
    const std::string what = e.what();
    writeAll(descriptor, what.data(), what.size());
    status = 1;
  }
  _exit(status);
}

double statusEntry(const std::string& name) {
  std::ifstream in("/proc/self/status");
  for (std::string word; in >> word;)
    if (word == name + ":") {
      double kilobytes = 0;
      in >> kilobytes;
      return kilobytes * 1024;
    }
  return 0;
}

}  // namespace

std::vector<double> runInChild(const std::function<std::vector<double>()>& action) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe to a child process");
  std::cout.flush();
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no child process");
  if (child == 0) {
    close(ends[0]);
    beChild(ends[1], action);
  }
  close(ends[1]);
  const std::string bytes = readAll(ends[0]);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status))
    throw std::runtime_error("ended by signal " + std::to_string(WTERMSIG(status)));
  if (WEXITSTATUS(status) != 0) throw std::runtime_error(bytes);
  const auto* const numbers = reinterpret_cast<const double*>(bytes.data());
  return {numbers, numbers + bytes.size() / sizeof(double)};
}

double residentBytes() {
  malloc_trim(0);
  return statusEntry("VmRSS");
}

double peakBytes() { return statusEntry("VmHWM"); }

void resetPeak() { std::ofstream("/proc/self/clear_refs") << 5; }

}  // namespace insertion_benchmark
