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
  const Descriptor there(open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK));
  std::error_code ignored;
  if (there >= 0 && flock(there, LOCK_EX | LOCK_NB) == 0) fs::remove_all(path, ignored);
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
  m_descriptor = Descriptor(-1);  // first: to remove a folder takes one, and this may be the last
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
    m_descriptor = Descriptor(open(m_path.c_str(), O_RDWR | O_CREAT | O_EXCL | kSafely, 0666));
  else if (mkdir(m_path.c_str(), 0777) == 0) {
    m_descriptor = Descriptor(open(m_path.c_str(), O_RDONLY | O_DIRECTORY | kSafely));
    if (m_descriptor < 0 && errno == ENOENT) return false;
  }
  if (m_descriptor >= 0) return true;
  if (errno == EEXIST) return false;
  throw fs::filesystem_error("cannot be made", m_path, {errno, std::generic_category()});
}

/** False if, before it was locked, another process took it for one of the dead. */
bool Unfinished::lock() {
  flock(m_descriptor, LOCK_EX);
  return leadsTo(m_path, m_descriptor);
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

Descriptor openToSync(const fs::path& path) {
  Descriptor there(open(orHere(path).c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (there < 0) throw std::runtime_error(std::strerror(errno));
  return there;
}

}  // namespace strict_files
