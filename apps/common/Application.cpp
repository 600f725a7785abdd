#include "Application.h"

#include <malloc.h>
#include <strict_files/OutputFiles.h>
#include <strict_files/TextFile.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <memory>
#include <regex>
#include <set>
#include <stdexcept>
#include <utility>

namespace {

std::string camelCase(const std::string& name) {
  std::string word;
  for (std::size_t i = 0; i < name.size(); ++i)
    if (name[i] == '_' && i + 1 < name.size())
      word += static_cast<char>(std::toupper(static_cast<unsigned char>(name[++i])));
    else
      word += name[i];
  return word;
}

}  // namespace

nlohmann::ordered_json jsonOf(const strict_files::OptionList& options) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const strict_files::Option& option : options.options()) {
    const std::string text = option.text();
    const auto value = nlohmann::ordered_json::parse(text, nullptr, false);
    const bool isText = !value.is_number() && !value.is_boolean();
    json[camelCase(option.name)] = isText ? nlohmann::ordered_json(text) : value;
  }
  return json;
}

std::string textOf(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void writeJson(const std::filesystem::path& file, const nlohmann::ordered_json& json) {
  strict_files::writeText(file, textOf(json));
}

namespace fs = std::filesystem;

CLI::Option* Outputs::add(CLI::App& app, fs::path& output, const std::string& type,
                          const std::string& what) {
  return finish(app, app.add_option("-o,--output", output, what)->type_name(type));
}

CLI::Option* Outputs::add(CLI::App& app, std::vector<fs::path>& outputs, const std::string& type,
                          const std::string& what) {
  return finish(
      app, app.add_option("-o,--output", outputs, what)->type_name(type)->allow_extra_args(false));
}

CLI::Option* Outputs::finish(CLI::App& app, CLI::Option* option) {
  app.add_flag("-f,--overwrite", m_overwrite, "Replace files that exist");
  app.add_flag_callback("-q,--quiet", beQuiet, "Say nothing but errors");
  addOther(option);
  return option;
}

void Outputs::check(const std::vector<fs::path>& files, const std::vector<fs::path>& more) const {
  std::vector<fs::path> inputs = more;
  for (const CLI::Option* option : optionsOf(m_app))
    if (std::find(m_options.begin(), m_options.end(), option) == m_options.end())
      inputs.insert(inputs.end(), option->results().begin(), option->results().end());
  std::error_code error;
  std::set<fs::path> seen;
  for (const fs::path& file : files) {
    if (!file.empty() && !seen.insert(file.lexically_normal()).second)
      throw std::runtime_error(file.string() + ": would be written twice");
    if (!m_overwrite && !file.empty()) strict_files::declareNew(file);
    if (!fs::exists(fs::symlink_status(file, error))) continue;
    for (const fs::path& input : inputs)
      if (fs::equivalent(file, input, error))
        throw std::runtime_error(file.string() + ": is an input, and never written over");
    if (!m_overwrite)
      throw std::runtime_error(file.string() + ": is there already; -f (--overwrite) replaces it");
  }
}

void Outputs::checkFolder(const fs::path& folder, const std::vector<std::string>& names,
                          const std::vector<fs::path>& more) const {
  std::vector<fs::path> files;
  if (folder.empty()) return;
  for (const std::string& name : names) files.push_back(folder / name);
  check(files, more);
}

namespace {

std::string withDashes(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

std::string capitalized(std::string text) {
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

/** "{compressed,halton}", as addWords() has it; "0 to 2", as addNumber() has it; or "NUMBER". */
std::string typeOf(const strict_files::Option& option) {
  static const std::regex bounded("a (whole )?number from (.*)"), choice("one of (.*)");
  std::smatch parts;
  if (std::regex_match(option.expected, parts, bounded)) return parts[2];
  if (!std::regex_match(option.expected, parts, choice)) return "NUMBER";
  return "{" + std::regex_replace(parts[1].str(), std::regex(" "), "") + "}";
}

std::string helpOf(const strict_files::Option& option) {
  const std::string help =
      capitalized(option.help) + (option.unit.empty() ? "" : ", ") + option.unit;
  const bool isSaid = typeOf(option) != "NUMBER" || option.expected == "a number";
  return isSaid ? help : help + " (" + option.expected + ")";
}

void addSwitch(CLI::App& app, const strict_files::Option& option, const std::string& group) {
  const bool on = option.text() == "true";
  const std::string name = withDashes(option.name);
  app.add_flag_callback((on ? "--no-" : "--") + name,
                        [set = option.set, on] { set(on ? "false" : "true"); },
                        on ? "Do not " + option.help : capitalized(option.help))
      ->group(group);
}

}  // namespace

void addOptions(CLI::App& app, const strict_files::OptionList& list, const std::string& group) {
  for (const strict_files::Option& option : list.options()) {
    if (option.isSwitch) {
      addSwitch(app, option, group);
      continue;
    }
    const std::string flag = "--" + withDashes(option.name);
    const auto read = [set = option.set, flag](const std::vector<std::string>& words) {
      try {
        set(words.back());
      } catch (const std::invalid_argument& e) {
        throw CLI::ValidationError(flag + " " + e.what());
      }
      return true;
    };
    app.add_option(flag, read, helpOf(option))
        ->type_name(typeOf(option))
        ->default_str(option.text())
        ->group(group);
  }
}

CLI::Validator isNumber(const strict_files::Range& range) {
  const auto number = std::make_shared<double>();
  strict_files::OptionList list;
  list.add("number", *number, "", range, "");
  const auto check = [number, option = list.options().front()](const std::string& text) {
    try {
      option.set(text);
      return std::string();
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
  };
  const bool bounded = std::isfinite(range.low) && std::isfinite(range.high);
  const std::string words =
      strict_files::textOf(range.low) + " to " + strict_files::textOf(range.high);
  return CLI::Validator(check, bounded ? words : "");
}

namespace {

bool isGroup(const CLI::App& app) { return app.get_name().empty(); }

/** Negative numbers are values. */
bool isOption(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && !std::isdigit(static_cast<unsigned char>(word[1])) &&
         word[1] != '.';
}

std::vector<std::string> namesOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : optionsOf(app)) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

std::vector<std::string> commandsOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr))
    if (!isGroup(*command)) names.push_back(command->get_name());
  return names;
}

/** Names an argument that was left over; empty if there is none. */
std::string unexpected(const CLI::App& app) {
  const std::vector<std::string> words = app.remaining(true);
  const std::vector<std::string> commands = commandsOf(app), known = namesOf(app);
  for (const std::string& word : words) {
    if (!isOption(word)) continue;
    const std::string name = word.substr(0, word.find('='));
    if (std::find(known.begin(), known.end(), name) != known.end())
      return name + " belongs behind the command";
    return "unknown option '" + name + "'" + strict_files::didYouMean(name, known);
  }
  if (words.empty()) return "";
  if (!commands.empty() && app.get_subcommands().empty())
    return strict_files::unknownWord("command", words.front(), commands);
  const bool writes = app.get_option_no_throw("--output") || !app.get_subcommands().empty();
  return "one argument too many: '" + words.front() + "'" +
         (writes ? " (what is written is named by -o)" : "");
}

/** Names an option that has another option in place of its last values; empty if none has. */
std::string lackingValues(const CLI::App& app) {
  const std::vector<std::string> known = namesOf(app);
  for (const CLI::Option* option : optionsOf(app))
    for (const std::string& word : option->results())
      if (option->get_items_expected_min() > 1 &&
          std::find(known.begin(), known.end(), word) != known.end())
        return option->get_name() + ": expected " + option->get_type_name();
  return "";
}

/** "NUMBER", "{one,other}", "1 to 8", whatever CLI11 calls it. Texts are names of files, where
 * options do not say something else. */
std::string readableType(const std::string& type) {
  static const std::regex theirs("(INT|UINT|FLOAT|TEXT|ENUM|BOOLEAN)(:(.*))?");
  std::smatch parts;
  if (!std::regex_match(type, parts, theirs)) return type;
  if (parts[3].length() > 0) return parts[3];
  return parts[1] == "TEXT" ? "FILE" : "NUMBER";
}

/** What CLI11 says, in the words of our own messages. */
std::string readableMessage(const std::string& message) {
  static const std::pair<std::regex, std::string> ours[] = {
      {std::regex("^(--?[a-z-]+): \\1:"), "$1:"},
      {std::regex("^(--?[a-z-]+): (is )"), "$1 $2"},
      {std::regex(": 1 required .* missing$"), " lacks its value"},
      {std::regex(": [0-9]+ required (.*) missing$"), ": expected $1"},
      {std::regex(": At Most 1 required but received ([0-9]+)$"), " is given $1 times"},
      {std::regex("^A subcommand is required$"), "a command is missing"}};
  std::string text = message;
  for (const auto& [theirs, words] : ours)
    text = std::regex_replace(text, theirs, words, std::regex_constants::format_first_only);
  return text;
}

class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_name(const CLI::Option* option, bool positional) const override {
    const std::string name = Formatter::make_option_name(option, positional);
    return std::regex_replace(name, std::regex(R"(\{[^}]*\})"), "");
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    const std::string type = option->get_type_name(),
                      readable = option->get_positional() ? "" : readableType(type);
    std::string text = Formatter::make_option_opts(option);
    const std::size_t at = type.empty() ? std::string::npos : text.find(type);
    return at == std::string::npos ? text : text.replace(at, type.size(), readable);
  }
};

}  // namespace

std::vector<const CLI::Option*> optionsOf(const CLI::App& app) {
  std::vector<const CLI::Option*> all = app.get_options();
  for (const CLI::App* part : app.get_subcommands(nullptr))
    if (isGroup(*part) || part->parsed()) {
      const auto more = optionsOf(*part);
      all.insert(all.end(), more.begin(), more.end());
    }
  return all;
}

std::string problemOf(const CLI::App& app, const CLI::ParseError& error) {
  if (const std::string lacking = lackingValues(app); !lacking.empty()) return lacking;
  const std::string surplus = unexpected(app);
  return surplus.empty() ? readableMessage(error.what()) : surplus;
}

void makeHelpReadable(CLI::App& app) {
  app.formatter(std::make_shared<HelpFormatter>());
  for (CLI::App* part : app.get_subcommands(nullptr)) makeHelpReadable(*part);
}

namespace {

constexpr int kUsage = 64;  // EX_USAGE of sysexits.h

[[noreturn]] void leaveSaying(const char* what) {
  const char* const line[] = {program_invocation_short_name, ": ", what, "\n"};
  for (const char* part : line) (void)!write(STDERR_FILENO, part, std::strlen(part));
  _exit(1);
}

/** Where nobody can catch it (in libraries before main(), in threads), a limit of memory ends the
 * program with a message, too. */
[[noreturn]] void leaveUncaught() {
  if (!std::current_exception()) std::abort();
  try {
    throw;
  } catch (const std::bad_alloc&) {
    leaveSaying("more memory is needed than there is");
  } catch (const std::exception& e) {
    leaveSaying(e.what());
  }
}

void setLeaving() { std::set_terminate(leaveUncaught); }

/** Before all libraries' own beginnings. */
[[gnu::section(".preinit_array"), gnu::used]] void (*const atFirst)() = setLeaving;

/** Begin and end of a message that quotes a file, whose words may be as long as the file. */
std::string shortened(std::string text) {
  constexpr std::size_t kEnd = 1000;
  if (text.size() > 2 * kEnd) text.replace(kEnd, text.size() - 2 * kEnd, " ... ");
  return text;
}

int parseAndRun(CLI::App& app, int argc, char** argv, const std::function<int()>& program) {
  const auto complain = [&app](const std::string& message) {
    std::cerr << app.get_name() << ": " << strict_files::printable(shortened(message)) << std::endl;
  };
  try {
    app.parse(argc, argv);
    const SignalWatch watch(app.get_name());
    const int status = program();
    return SignalWatch::stoppedBy() != 0 ? 128 + SignalWatch::stoppedBy() : status;
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    complain(problemOf(app, e));
    std::cerr << "See " << app.get_name() << " --help" << std::endl;
    return kUsage;
  } catch (const StoppedTooEarly& e) {
    complain(e.what());
    return 128 + SignalWatch::stoppedBy();
  } catch (const std::exception& e) {
    complain(strict_files::messageOf(e));
    return 1;
  }
}

}  // namespace

int runApplication(CLI::App& app, int argc, char** argv, const std::function<int()>& program) {
  app.name(std::filesystem::path(argv[0]).filename().string());
  app.set_version_flag("--version", MSO_VERSION);
  makeHelpReadable(app);
  openStandardStreams();
  mallopt(M_ARENA_MAX, 1);  // scans that one thread makes and another frees would leave gaps in two
  const int status = parseAndRun(app, argc, argv, program);
  if (!flushStandardOutput()) {
    std::cerr << app.get_name() << ": the standard output cannot be written" << std::endl;
    return status == 0 ? 1 : status;
  }
  return status;
}
