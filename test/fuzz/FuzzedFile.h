#pragma once
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

/** For functions that want a file: the bytes are one, with an ending of their choice. */
template <typename F>
auto fromFile(const std::string& ending, const F& read) {
  return [ending, read](const std::string& bytes) {
    namespace fs = std::filesystem;
    const fs::path file =
        fs::temp_directory_path() / ("mso_fuzz_" + std::to_string(getpid()) + ending);
    std::ofstream(file, std::ios::binary) << bytes;
    try {
      read(file);
    } catch (...) {
      fs::remove(file);
      throw;
    }
    fs::remove(file);
  };
}
