#include "Outputs.h"

#include <strict_files/OutputFiles.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "Application.h"
#include "StandardOutput.h"

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
  app.add_flag("-f,--overwrite", m_overwrite, "Write over what is there");
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
