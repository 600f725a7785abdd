#include <strict_files/OutputFolder.h>
#include <sys/file.h>

#include <stdexcept>

#include "Placing.h"

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

void OutputFolder::takeAlong(const std::string& lock) { m_staging->takeAlong(lock); }

/** Where each file goes, when all are on the disk. \throw filesystem_error or runtime_error */
Placement OutputFolder::prepare(const std::string& name) const {
  checkPlace(m_folder / name);
  if (!fs::exists(staged(name))) return {{}, m_folder / name};
  synchronize(staged(name));
  return {staged(name), m_folder / name};
}

void OutputFolder::commit(const std::vector<std::string>& names) {
  const auto each = [&](auto action) {
    for (std::size_t i = 0; i < names.size(); ++i) try {
        action(i);
      } catch (const PlaceTaken& e) {
        keepAndReport(m_folder / names[i], *m_staging, e);
      } catch (const fs::filesystem_error& e) {
        throw std::runtime_error((m_folder / names[i]).string() +
                                 ": cannot be written: " + e.code().message());
      } catch (const std::exception& e) {
        throw std::runtime_error((m_folder / names[i]).string() +
                                 ": cannot be written: " + e.what());
      }
  };
  std::vector<Placement> placements;  // what can fail comes first
  each([&](std::size_t i) { placements.push_back(prepare(names[i])); });
  const OpenFolder folder(m_folder);
  flock(folder.descriptor(), LOCK_EX);  // of two at the same time, the files are of one
  const auto held = Unfinished::hold();
  each([&](std::size_t i) { placements[i].checkFree(); });
  each([&](std::size_t i) { placements[i].take(); });
  try {
    folder.synchronize();
  } catch (const std::exception& e) {
    throw std::runtime_error(m_folder.string() + ": cannot be written: " + e.what());
  }
}

}  // namespace strict_files
