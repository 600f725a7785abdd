#include "Unfinished.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <random>
#include <set>

namespace strict_files {

namespace fs = std::filesystem;

namespace {

const std::string kPrefix = ".unfinished-";
constexpr std::size_t kLetters = 6;

struct Registry {
  std::mutex mutex;
  std::set<Unfinished*> all;
  std::set<fs::path> cleaned;  ///< folders without anything dead
};

/** The registry of this process. It is never destroyed, for some outputs live as long. */
Registry& registry() {
  static Registry* const theOne = new Registry;
  return *theOne;
}

std::string newName(const std::string& ending) {
  static const std::string alphabet = "abcdefghijklmnopqrstuvwxyz0123456789";
  std::random_device random;
  std::uniform_int_distribution<std::size_t> letter(0, alphabet.size() - 1);
  std::string name = kPrefix;
  for (std::size_t i = 0; i < kLetters; ++i) name += alphabet[letter(random)];
  constexpr std::size_t kLongest = 200;  // of 255 bytes that a name may have
  if (ending.empty()) return name;
  return name + '-' + ending.substr(ending.size() - std::min(ending.size(), kLongest));
}

/** Whether newName() may have given it. */
bool isName(const std::string& name) {
  const std::size_t end = kPrefix.size() + kLetters;
  if (name.rfind(kPrefix, 0) != 0 || name.size() < end || (name.size() > end && name[end] != '-'))
    return false;
  for (std::size_t i = kPrefix.size(); i < end; ++i)
    if (!std::isalnum(static_cast<unsigned char>(name[i]))) return false;
  return true;
}

/** Removes it unless somebody holds its lock. Where there are no locks, it stays. */
void removeIfDead(const fs::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return;
  std::error_code ignored;
  if (flock(descriptor, LOCK_EX | LOCK_NB) == 0) fs::remove_all(path, ignored);
  close(descriptor);
}

void removeDead(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (isName(it->path().filename().string())) removeIfDead(it->path());
}

/** Whether nothing else is in its folder. */
bool isAlone(const fs::path& file) {
  std::error_code error;
  for (fs::directory_iterator it(file.parent_path(), error), end; !error && it != end;
       it.increment(error))
    if (it->path().filename() != file.filename()) return false;
  return !error;
}

fs::path orHere(const fs::path& folder) { return folder.empty() ? fs::path(".") : folder; }

}  // namespace

Unfinished::Unfinished(const fs::path& folder, Kind kind, const std::string& ending)
    : m_folder(orHere(folder)) {
  const auto held = hold();
  if (kind == Kind::Folder) m_madeFolder = fs::create_directories(m_folder);
  if (registry().cleaned.insert(m_folder).second) removeDead(m_folder);
  do {
    m_path = folder / newName(ending);
  } while (!make(kind) || !lock());
  registry().all.insert(this);
}

Unfinished::~Unfinished() {
  const auto held = hold();
  registry().all.erase(this);
  close(m_descriptor);  // first: to remove a folder takes a descriptor, and this may be the last
  discard();
}

fs::path Unfinished::keep() {
  const std::string name = "kept-" + m_path.filename().string().substr(kPrefix.size());
  const fs::path kept = m_path.parent_path() / name;
  fs::rename(m_path, kept);
  m_path.clear();
  return kept;
}

std::unique_lock<std::mutex> Unfinished::hold() { return std::unique_lock(registry().mutex); }

/** False if the name is taken, or another process took the folder for one of the dead. */
bool Unfinished::make(Kind kind) {
  constexpr int kSafely = O_NOFOLLOW | O_CLOEXEC;
  if (kind == Kind::File)
    m_descriptor = open(m_path.c_str(), O_RDWR | O_CREAT | O_EXCL | kSafely, 0666);
  else if (mkdir(m_path.c_str(), 0777) == 0) {
    m_descriptor = open(m_path.c_str(), O_RDONLY | O_DIRECTORY | kSafely);
    if (m_descriptor < 0 && errno == ENOENT) return false;
  }
  if (m_descriptor >= 0) return true;
  if (errno == EEXIST) return false;
  throw fs::filesystem_error("cannot be made", m_path, {errno, std::generic_category()});
}

/** False if, before it was locked, another process took it for one of the dead. */
bool Unfinished::lock() {
  flock(m_descriptor, LOCK_EX);
  if (leadsTo(m_path, m_descriptor)) return true;
  close(m_descriptor);
  m_descriptor = -1;
  return false;
}

void Unfinished::discard() noexcept {
  std::error_code ignored;
  fs::remove_all(m_path, ignored);
  if (!m_companion.empty() && isAlone(m_companion)) fs::remove(m_companion, ignored);
  if (m_madeFolder) fs::remove(m_folder, ignored);  // only if it is empty
}

void leaveWithoutOutputs(int status) {
  const auto held = Unfinished::hold();  // to the end: nothing is begun or takes its place now
  for (int i = 0; i < 2; ++i)            // a folder that is in another may be the last to leave it
    for (Unfinished* unfinished : registry().all) unfinished->discard();
  _exit(status);
}

bool leadsTo(const fs::path& path, int descriptor) {
  struct stat open = {}, there = {};
  return fstat(descriptor, &open) == 0 && stat(path.c_str(), &there) == 0 &&
         open.st_ino == there.st_ino && open.st_dev == there.st_dev;
}

void synchronize(int descriptor) {
  if (fsync(descriptor) != 0 && errno != EINVAL && errno != EROFS)
    throw std::runtime_error(std::strerror(errno));
}

void synchronize(const fs::path& path) {
  const int descriptor = open(orHere(path).c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) throw std::runtime_error(std::strerror(errno));
  try {
    synchronize(descriptor);
  } catch (const std::exception&) {
    close(descriptor);
    throw;
  }
  close(descriptor);
}

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
