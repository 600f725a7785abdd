#include "RunProgram.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "TemporaryFolder.h"

namespace {

void redirect(int descriptor, const std::filesystem::path& file, int flags) {
  dup2(open(file.c_str(), flags, 0600), descriptor);
}

[[noreturn]] void execute(const std::string& program, const std::vector<std::string>& arguments,
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

ProgramRun runProgram(const std::string& name, const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  const pid_t child = fork();
  if (child == 0) execute(std::filesystem::path(MSO_BIN_DIR) / name, arguments, folder);
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), folder.read("output"),
          folder.read("errors"), usage.ru_maxrss};
}
