#pragma once
#include <CLI/CLI.hpp>
#include <functional>

/** The `main` of all applications: reads the command line, which knows --version, too, and runs. An
 * exception becomes a line on the standard error output.
 * \return the program's exit status; 1 after an exception, CLI11's after a wrong command line */
int runApplication(CLI::App& app, int argc, char** argv, const std::function<int()>& program);
