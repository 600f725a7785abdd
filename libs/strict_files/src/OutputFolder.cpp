#include <fcntl.h>
#include <strict_files/OutputFolder.h>
#include <sys/file.h>
#include <unistd.h>

#include <stdexcept>

#include "Unfinished.h"

namespace strict_files {

namespace fs = std::filesystem;

namespace {

/** \throw std::runtime_error something else than a file is there. */
void checkPlace(const fs::path& place) {
  std::error_code error;
  const fs::file_status status = fs::status(place, error);
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw std::runtime_error(fs::is_directory(status) ? "it is a folder" : "it is no regular file");
}

/** As long as it lives, other processes wait to have one for the same folder. */
class FolderLock {
 public:
  explicit FolderLock(const fs::path& folder)
      : m_descriptor(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    flock(m_descriptor, LOCK_EX);
  }
  ~FolderLock() { close(m_descriptor); }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int m_descriptor;
};

}  // namespace

OutputFolder::OutputFolder(fs::path folder) : m_folder(std::move(folder)) {
  try {
    m_staging = std::make_unique<Unfinished>(m_folder, Unfinished::Kind::Folder);
  } catch (const fs::filesystem_error& e) {
    throw std::runtime_error(m_folder.string() +
                             ": cannot write into this folder: " + e.code().message());
  }
}

OutputFolder::~OutputFolder() = default;

fs::path OutputFolder::staged(const std::string& name) const { return m_staging->path() / name; }

void OutputFolder::commit(const std::vector<std::string>& names) {
  const auto each = [&](auto action) {
    for (const std::string& name : names) try {
        action(name);
      } catch (const fs::filesystem_error& e) {
        throw std::runtime_error((m_folder / name).string() +
                                 ": cannot be written: " + e.code().message());
      } catch (const std::exception& e) {
        throw std::runtime_error((m_folder / name).string() + ": cannot be written: " + e.what());
      }
  };
  each([&](const std::string& name) {  // what can fail comes first
    checkPlace(m_folder / name);
    if (fs::exists(staged(name))) synchronize(staged(name));
  });
  const FolderLock lock(m_folder);  // of two at the same time, the files are of one
  const auto held = Unfinished::hold();
  each([&](const std::string& name) { put(name); });
  synchronize(m_folder);
}

void OutputFolder::put(const std::string& name) {
  if (fs::exists(staged(name)))
    fs::rename(staged(name), m_folder / name);
  else
    fs::remove(m_folder / name);
}

}  // namespace strict_files
