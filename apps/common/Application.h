#pragma once
#include <CLI/CLI.hpp>
#include <functional>

/** The `main` of all applications: reads the command line, which knows --version, too, and runs. An
 * exception becomes a line on the standard error output. SIGINT, SIGTERM and SIGHUP end the program
 * without leaving half of an output behind, unless it has a StopRequest.
 * \return the program's exit status; 64 after a wrong command line (a CLI::ParseError, of the
 * program's, too), 1 after other exceptions, or if the standard output did not take everything;
 * 128 and the signal's number if it was asked to stop before its end. */
int runApplication(CLI::App& app, int argc, char** argv, const std::function<int()>& program);
