#include "Placing.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <set>

namespace strict_files {

namespace fs = std::filesystem;

namespace {

struct NewFiles {
  std::mutex mutex;
  std::set<fs::path> all;
};

/** The new files of this process. They are never destroyed, as Unfinished's registry. */
NewFiles& newFiles() {
  static NewFiles* const theOnes = new NewFiles;
  return *theOnes;
}

fs::path keyOf(const fs::path& file) { return fs::absolute(file).lexically_normal(); }

void check(bool success, const fs::path& file) {
  if (success) return;
  if (errno == EEXIST) throw PlaceTaken();
  throw fs::filesystem_error("cannot be renamed", file, {errno, std::generic_category()});
}

}  // namespace

void declareNew(const fs::path& file) {
  const std::lock_guard lock(newFiles().mutex);
  newFiles().all.insert(keyOf(file));
}

Placement::Placement(fs::path file, const fs::path& place)
    : m_file(std::move(file)), m_place(place), m_key(keyOf(place)) {
  const std::lock_guard lock(newFiles().mutex);
  m_isNew = newFiles().all.count(m_key) > 0;
}

void Placement::checkFree() const {
  if (m_isNew && !m_file.empty() && fs::exists(fs::symlink_status(m_place))) throw PlaceTaken();
}

void Placement::take() const {
  if (m_file.empty()) {
    if (!m_isNew) fs::remove(m_place);
  } else if (m_isNew) {
    takeNew();
    const std::lock_guard lock(newFiles().mutex);
    newFiles().all.erase(m_key);
  } else {
    fs::rename(m_file, m_place);
  }
}

/** File systems that cannot rename without replacing have links, or neither: then only a look
 * tells. */
void Placement::takeNew() const {
  const char *from = m_file.c_str(), *to = m_place.c_str();
  if (renameat2(AT_FDCWD, from, AT_FDCWD, to, RENAME_NOREPLACE) == 0) return;
  if (errno != EINVAL && errno != ENOSYS) check(false, m_file);
  if (link(from, to) == 0) return check(unlink(from) == 0, m_file);
  if (errno != EPERM && errno != EOPNOTSUPP) check(false, m_file);
  checkFree();
  fs::rename(m_file, m_place);
}

OpenFolder::OpenFolder(const fs::path& folder)
    : m_descriptor(
          open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (m_descriptor < 0) throw std::runtime_error(std::strerror(errno));
}

OpenFolder::~OpenFolder() { close(m_descriptor); }

void OpenFolder::synchronize() const { strict_files::synchronize(m_descriptor); }

void keepAndReport(const fs::path& target, Unfinished& unfinished, const PlaceTaken& why) {
  throw std::runtime_error(target.string() + ": cannot be written: " + why.what() +
                           "; what belongs there is now " + unfinished.keep().string());
}

}  // namespace strict_files
