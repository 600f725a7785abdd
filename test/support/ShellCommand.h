#pragma once
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

/** What came of a shell's command; output: what it printed, errors too. */
struct CommandRun {
  int status = -1;  ///< exit status; 128 and the signal's number after a crash
  std::string output;
};

inline CommandRun runCommand(const std::string& command) {
  CommandRun run;
  FILE* pipe = popen((command + " 2>&1 </dev/null").c_str(), "r");
  std::array<char, 4096> part;
  while (const std::size_t n = fread(part.data(), 1, part.size(), pipe))
    run.output.append(part.data(), n);
  const int status = pclose(pipe);
  run.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return run;
}
