#pragma once
#include <CLI/CLI.hpp>

#include <functional>
#include <string>
#include <vector>

/** All options, those of groups and of the subcommands that were given, too. */
std::vector<const CLI::Option*> optionsOf(const CLI::App& app);

/** What is wrong with the command line. Unknown options and commands come first, with the one that
 * was meant. */
std::string problemOf(const CLI::App& app, const CLI::ParseError& error);

/** Help in words: CLI11's names of types and checks are for programmers. */
void makeHelpReadable(CLI::App& app);

/** The `main` of all applications: reads the command line, which knows --version, too, and runs. An
 * exception becomes a line on the standard error output. SIGINT, SIGTERM and SIGHUP end the program
 * without leaving half of an output behind, unless it has a StopRequest.
 * \return the program's exit status; 64 after a wrong command line (a CLI::ParseError, of the
 * program's, too), 1 after other exceptions, or if the standard output did not take everything;
 * 128 and the signal's number if it was asked to stop before its end. */
int runApplication(CLI::App& app, int argc, char** argv, const std::function<int()>& program);
