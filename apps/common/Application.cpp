#include "Application.h"

#include <strict_files/ErrorMessage.h>

#include <filesystem>
#include <iostream>

int runApplication(CLI::App& app, int argc, char** argv, const std::function<int()>& program) {
  app.name(std::filesystem::path(argv[0]).filename().string());
  app.set_version_flag("--version", MSO_VERSION);
  CLI11_PARSE(app, argc, argv);
  try {
    return program();
  } catch (const std::exception& e) {
    std::cerr << app.get_name() << ": " << strict_files::messageOf(e) << std::endl;
    return 1;
  }
}
