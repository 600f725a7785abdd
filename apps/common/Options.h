#pragma once
#include <strict_files/OptionList.h>
#include <strict_files/Words.h>
#include <CLI/CLI.hpp>

#include <map>
#include <optional>
#include <string>
#include <vector>

/** Gives a program the options of a list: "max_range" is --max-range, with the help, what is
 * allowed and the default that the list has. A switch that is on by default is turned off by
 * --no-...; \param group heading in the help */
void addOptions(CLI::App& app, const strict_files::OptionList& list, const std::string& group);

/** For numbers of command lines: `option->check(isNumber(above(0)))` says of others "--rate is 0,
 * expected a number above 0". */
CLI::Validator isNumber(const strict_files::Range& range);

/** Gives the words that an option may be, which the help lists; case does not matter, and a word
 * that is unknown is answered by the nearest one. */
inline CLI::Option* addWords(CLI::Option* option, const std::vector<std::string>& words) {
  const auto choose = [words](std::string& value) {
    for (const std::string& word : words)
      if (strict_files::sameWord(word, value)) {
        value = word;
        return std::string();
      }
    return strict_files::unknownWord("value", value, words);
  };
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "{" : ",") + word;
  return option->transform(CLI::Validator(choose, list + "}"));
}

/** Gives the values of an option names, as addWords(). */
template <class Value>
CLI::Option* addChoice(CLI::Option* option, const std::map<std::string, Value>& names) {
  std::vector<std::string> words;
  for (const auto& [word, value] : names) words.push_back(word);
  option->transform(CLI::Transformer(names, CLI::ignore_case).description(""));
  return addWords(option, words);
}

/** An option whose value is a number, with its default in the help. */
template <class Number>
CLI::Option* addNumber(CLI::App& app, const std::string& name, Number& number,
                       const strict_files::Range& range, const std::string& help) {
  return app.add_option(name, number, help)->check(isNumber(range))->capture_default_str();
}

/** --memory, of programs that read maps tile by tile. */
inline void addMemoryOption(CLI::App& app, double& megabytes) {
  addNumber(app, "--memory", megabytes, strict_files::atLeast(0),
            "Memory for the tiles of a map in a folder, MB");
}

/** --tiles, of programs that write maps. */
inline void addTilesOption(CLI::App& app, std::optional<double>& edge) {
  app.add_option("--tiles", edge,
                 "Write a folder of tiles, cubes of this edge, m: 8, 16, 32 ... voxels")
      ->check(isNumber(strict_files::above(0)));
}
