#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

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
