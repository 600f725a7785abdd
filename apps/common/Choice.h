#pragma once
#include <strict_files/Words.h>

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

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
