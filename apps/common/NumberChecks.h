#pragma once
#include <strict_files/OptionList.h>

#include <CLI/CLI.hpp>

/** For numbers of command lines: `option->check(isNumber(above(0)))` says of others "--rate is 0,
 * expected a number above 0". */
CLI::Validator isNumber(const strict_files::Range& range);
