#pragma once
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

/** Takes a file or folder away at the end, however that comes. */
class Removed {
 public:
  explicit Removed(std::filesystem::path path) : m_path(std::move(path)) {}
  ~Removed() { std::filesystem::remove_all(m_path); }
  Removed(const Removed&) = delete;
  Removed& operator=(const Removed&) = delete;

  const std::filesystem::path& path() const { return m_path; }

 private:
  std::filesystem::path m_path;
};

/** In the folder for temporary files, of this process. */
inline std::filesystem::path fuzzedPath(const std::string& ending) {
  return std::filesystem::temp_directory_path() / ("mso_fuzz_" + std::to_string(getpid()) + ending);
}

/** For functions that want a file: the bytes are one, with an ending of their choice. */
template <typename F>
auto fromFile(const std::string& ending, const F& read) {
  return [ending, read](const std::string& bytes) {
    const Removed file(fuzzedPath(ending));
    std::ofstream(file.path(), std::ios::binary) << bytes;
    read(file.path());
  };
}

/** For functions that want several files of a folder: between form feeds are the bytes of each, and
 * the last has all that is left. */
template <typename F>
auto fromFolder(const std::vector<std::string>& names, const F& read) {
  return [names, read](const std::string& bytes) {
    const Removed folder(fuzzedPath(".d"));
    std::filesystem::remove_all(folder.path());
    std::size_t begin = 0;
    for (const std::string& name : names) {
      const std::size_t end =
          &name == &names.back() ? bytes.size() : std::min(bytes.find('\f', begin), bytes.size());
      std::filesystem::create_directories((folder.path() / name).parent_path());
      std::ofstream(folder.path() / name, std::ios::binary) << bytes.substr(begin, end - begin);
      begin = std::min(end + 1, bytes.size());
    }
    read(folder.path());
  };
}
