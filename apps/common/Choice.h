#pragma once
#include <CLI/CLI.hpp>
#include <map>
#include <string>

/** Gives the values of an option names, which the help lists; case does not matter. */
template <class Value>
CLI::Option* addChoice(CLI::Option* option, const std::map<std::string, Value>& names) {
  std::string list;
  for (const auto& [name, value] : names) list += (list.empty() ? "{" : ",") + name;
  CLI::CheckedTransformer transformer(names, CLI::ignore_case);
  return option->transform(transformer.description(list + "}"))->type_name("TEXT");
}
