#pragma once
#include <strict_files/OptionList.h>

#include <CLI/CLI.hpp>
#include <string>

/** Gives a program the options of a list: "max_range" is --max-range, with the help, what is
 * allowed and the default that the list has. A switch that is on by default is turned off by
 * --no-...; \param group heading in the help */
void addOptions(CLI::App& app, const strict_files::OptionList& list, const std::string& group);
