#include "Application.h"

#include <strict_files/Words.h>

#include <filesystem>
#include <iostream>

#include "CommandLine.h"
#include "Signals.h"
#include "StandardOutput.h"

namespace {

constexpr int kUsage = 64;  // EX_USAGE of sysexits.h

int parseAndRun(CLI::App& app, int argc, char** argv, const std::function<int()>& program,
                const SignalWatch& watch) {
  const auto complain = [&app](const std::string& message) {
    std::cerr << app.get_name() << ": " << strict_files::printable(message) << std::endl;
  };
  try {
    app.parse(argc, argv);
    const int status = program();
    return watch.stoppedBy() != 0 ? 128 + watch.stoppedBy() : status;
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    complain(problemOf(app, e));
    std::cerr << "See " << app.get_name() << " --help" << std::endl;
    return kUsage;
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
  const SignalWatch watch(app.get_name());
  const int status = parseAndRun(app, argc, argv, program, watch);
  if (!flushStandardOutput()) {
    std::cerr << app.get_name() << ": the standard output cannot be written" << std::endl;
    return status == 0 ? 1 : status;
  }
  return status;
}
