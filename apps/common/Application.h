#pragma once
#include <strict_files/OptionList.h>
#include <strict_files/Words.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "Terminal.h"

/** As all programs write it: two spaces a level, and a line's end. Bytes that are no UTF-8 (names
 * of files may be) become U+FFFD. */
std::string textOf(const nlohmann::ordered_json& json);

/** The values of options: numbers, booleans, else texts; block_size is "blockSize". */
nlohmann::ordered_json jsonOf(const strict_files::OptionList& options);

/** Writes it into a file. \throw std::runtime_error naming the file: it cannot be written. */
void writeJson(const std::filesystem::path& file, const nlohmann::ordered_json& json);

/** The outputs of a program: nothing that is there is written over without -f, and no input ever
 * is. */
class Outputs {
 public:
  /** \param app Whose other options may name inputs. */
  explicit Outputs(CLI::App& app) : m_app(app) {}

  /** -o, --output, with what belongs to it: -f, --overwrite, and -q, --quiet.
   * \param app The program or a subcommand. \param type "FILE" or "FOLDER"
   * \param what "Rawlog to write" */
  CLI::Option* add(CLI::App& app, std::filesystem::path& output, const std::string& type,
                   const std::string& what);
  /** The option -o for several output files: it is given once for each. */
  CLI::Option* add(CLI::App& app, std::vector<std::filesystem::path>& outputs,
                   const std::string& type, const std::string& what);
  /** An option, declared otherwise, whose value is an output, too. */
  void addOther(CLI::Option* option) { m_options.push_back(option); }

  /** To be called before the work. \param files All that the program may write, those of its folder
   * one by one. \param more inputs beside those that the command line names.
   * \throw std::runtime_error naming a file that is an input, that is twice among them, or that is
   * there and was not allowed to be written over. */
  void check(const std::vector<std::filesystem::path>& files,
             const std::vector<std::filesystem::path>& more = {}) const;
  /** Checks these files of a folder likewise, if there is to be one. */
  void checkFolder(const std::filesystem::path& folder, const std::vector<std::string>& names,
                   const std::vector<std::filesystem::path>& more = {}) const;

 private:
  CLI::Option* finish(CLI::App& app, CLI::Option* option);

  CLI::App& m_app;
  std::vector<const CLI::Option*> m_options;
  bool m_overwrite = false;
};

/** Gives a program the options of a list: "max_range" is --max-range, with the help, what is
 * allowed and the default that the list has. A switch that is on by default is turned off by
 * --no-...; \param group heading in the help */
void addOptions(CLI::App& app, const strict_files::OptionList& list, const std::string& group);

/** For numbers of command lines: `option->check(isNumber(above(0)))` says of others "--rate is 0,
 * expected a number above 0". */
CLI::Validator isNumber(const strict_files::Range& range);

/** Gives the words that an option may be, which the help lists. Case does not matter; an unknown
 * word is answered by the nearest one. */
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
 * \return the program's exit status. 64: a wrong command line (CLI::ParseError, also of the
 * program's own). 1: other exceptions, or the standard output did not take everything. 128 and the
 * signal's number: it was asked to stop before its end. */
int runApplication(CLI::App& app, int argc, char** argv, const std::function<int()>& program);
