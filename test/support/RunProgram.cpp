#include "RunProgram.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>

namespace {

void redirect(int descriptor, const std::filesystem::path& file, int flags) {
  dup2(open(file.c_str(), flags, 0600), descriptor);
}

[[noreturn]] void execute(const std::string& program, const Words& arguments,
                          const TemporaryFolder& folder) {
  redirect(STDIN_FILENO, "/dev/null", O_RDONLY);
  redirect(STDOUT_FILENO, folder / "output", O_WRONLY | O_CREAT);
  redirect(STDERR_FILENO, folder / "errors", O_WRONLY | O_CREAT);
  std::vector<char*> argv = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execv(program.c_str(), argv.data());
  _exit(127);
}

}  // namespace

ProgramRun runProgram(const std::string& name, const Words& arguments) {
  const TemporaryFolder folder;
  const pid_t child = fork();
  if (child == 0) execute(std::filesystem::path(MSO_BIN_DIR) / name, arguments, folder);
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), folder.read("output"),
          folder.read("errors"), usage.ru_maxrss};
}

/** What `timeout` kills may die after `timeout` does: all that inherit a pipe are waited for. */
ProgramRun runCommand(const std::string& command) {
  int ends[2];
  if (pipe(ends) != 0) return {};
  ProgramRun run = runProgram("/bin/sh", {"-c", command + " 2>&1"});
  close(ends[1]);
  char nothing;
  while (read(ends[0], &nothing, 1) > 0) continue;
  close(ends[0]);
  return run;
}

ProgramRun succeeded(ProgramRun run) {
  EXPECT_EQ(run.status, 0) << run.output << run.errors;
  return run;
}

void expectRefusal(const ProgramRun& run, const Words& parts) {
  EXPECT_EQ(run.status, 1) << run.errors;
  EXPECT_EQ(std::count(run.errors.begin(), run.errors.end(), '\n'), 1) << run.errors;
  for (const std::string& part : parts) EXPECT_TRUE(contains(run.errors, part));
}
