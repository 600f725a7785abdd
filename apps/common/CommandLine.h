#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

/** All options, those of groups and of the subcommands that were given, too. */
std::vector<const CLI::Option*> optionsOf(const CLI::App& app);

/** What is wrong with the command line. Unknown options and commands come first, with the one that
 * was meant. */
std::string problemOf(const CLI::App& app, const CLI::ParseError& error);

/** Help in words: CLI11's names of types and checks are for programmers. */
void makeHelpReadable(CLI::App& app);
