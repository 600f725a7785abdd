#include "Application.h"

#include <strict_files/Words.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>

#include "CommandLine.h"
#include "Signals.h"
#include "StandardOutput.h"

namespace {

constexpr int kUsage = 64;  // EX_USAGE of sysexits.h

[[noreturn]] void leaveSaying(const char* what) {
  const char* const line[] = {program_invocation_short_name, ": ", what, "\n"};
  for (const char* part : line) (void)!write(STDERR_FILENO, part, std::strlen(part));
  _exit(1);
}

/** Where nobody can catch it (in libraries before main(), in threads), a limit of memory ends the
 * program with a message, too. */
[[noreturn]] void leaveUncaught() {
  if (!std::current_exception()) std::abort();
  try {
    throw;
  } catch (const std::bad_alloc&) {
    leaveSaying("more memory is needed than there is");
  } catch (const std::exception& e) {
    leaveSaying(e.what());
  }
}

void setLeaving() { std::set_terminate(leaveUncaught); }

/** Before all libraries' own beginnings. */
[[gnu::section(".preinit_array"), gnu::used]] void (*const atFirst)() = setLeaving;

int parseAndRun(CLI::App& app, int argc, char** argv, const std::function<int()>& program) {
  const auto complain = [&app](const std::string& message) {
    std::cerr << app.get_name() << ": " << strict_files::printable(message) << std::endl;
  };
  try {
    app.parse(argc, argv);
    const SignalWatch watch(app.get_name());
    const int status = program();
    return SignalWatch::stoppedBy() != 0 ? 128 + SignalWatch::stoppedBy() : status;
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    complain(problemOf(app, e));
    std::cerr << "See " << app.get_name() << " --help" << std::endl;
    return kUsage;
  } catch (const StoppedTooEarly& e) {
    complain(e.what());
    return 128 + SignalWatch::stoppedBy();
  } catch (const std::exception& e) {
    complain(strict_files::messageOf(e));
    return 1;
  }
}

}  // namespace

int runApplication(CLI::App& app, int argc, char** argv, const std::function<int()>& program) {
  app.name(std::filesystem::path(argv[0]).filename().string());
  app.set_version_flag("--version", MSO_VERSION);
  makeHelpReadable(app);
  openStandardStreams();
  const int status = parseAndRun(app, argc, argv, program);
  if (!flushStandardOutput()) {
    std::cerr << app.get_name() << ": the standard output cannot be written" << std::endl;
    return status == 0 ? 1 : status;
  }
  return status;
}
