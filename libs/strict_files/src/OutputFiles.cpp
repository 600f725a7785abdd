#include <fcntl.h>
#include <strict_files/OutputFiles.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "Unfinished.h"

namespace strict_files {

namespace fs = std::filesystem;

namespace {

/** \throw std::runtime_error something else than a file is there. */
void checkPlace(const fs::path& place) {
  std::error_code error;
  const fs::file_status status = fs::status(place, error);
  if (fs::is_directory(status)) throw std::runtime_error("it is a folder");
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw std::runtime_error("it is no regular file");
}

/** What links lead to. \throw std::runtime_error nothing can be written there. */
fs::path placeOf(const fs::path& target) try {
  std::error_code error;
  const bool isLink = fs::is_symlink(target, error);
  const fs::path place = isLink ? fs::canonical(target, error) : target;
  if (isLink && error) throw std::runtime_error("it is a link that leads nowhere");
  checkPlace(place);
  return place;
} catch (const std::runtime_error& e) {
  throw std::runtime_error(target.string() + ": cannot be written, " + e.what());
}

/** What f() gives. \throw std::runtime_error naming the target */
template <typename F>
auto naming(const fs::path& target, const F& f) try {
  return f();
} catch (const fs::filesystem_error& e) {
  throw std::runtime_error(target.string() + ": cannot be written: " + e.code().message());
} catch (const std::exception& e) {
  throw std::runtime_error(target.string() + ": cannot be written: " + e.what());
}

/** The new files of this process, while Unfinished is held. They are never destroyed, for some
 * outputs live as long. */
std::set<fs::path>& newFiles() {
  static auto* const theOnes = new std::set<fs::path>;
  return *theOnes;
}

fs::path keyOf(const fs::path& file) { return fs::absolute(file).lexically_normal(); }

/** A file on its way to its name. What can fail for want of memory is done when it is made. */
class Move {
 public:
  /** \param from if it is not there, what has its name is removed, unless it was to be new */
  Move(fs::path from, fs::path to)
      : m_from(std::move(from)), m_to(std::move(to)), m_key(keyOf(m_to)) {
    const auto held = Unfinished::hold();
    m_isNew = newFiles().count(m_key) > 0;
  }
  const fs::path& to() const { return m_to; }
  /** False if the file was to be new, and something is there. */
  bool isFree() const {
    return !m_isNew || !fs::exists(m_from) || !fs::exists(fs::symlink_status(m_to));
  }
  /** \return isFree(): otherwise it is not done. Unfinished is held. */
  bool take() const {
    if (!isFree()) return false;
    if (!fs::exists(m_from)) {
      if (!m_isNew) fs::remove(m_to);
      return true;
    }
    const char *const from = m_from.c_str(), *const to = m_to.c_str();
    const bool isDone = m_isNew && renameat2(AT_FDCWD, from, AT_FDCWD, to, RENAME_NOREPLACE) == 0;
    if (m_isNew && !isDone && errno == EEXIST) return false;
    if (!isDone) fs::rename(m_from, m_to);  // not all file systems can: then isFree() has told
    newFiles().erase(m_key);
    return true;
  }

 private:
  fs::path m_from, m_to, m_key;
  bool m_isNew = false;
};

/** Leaves it there for the user, and says where. */
[[noreturn]] void keep(const fs::path& target, Unfinished& unfinished) {
  throw std::runtime_error(target.string() +
                           ": cannot be written: somebody else has written it since this program "
                           "began; what belongs there is now " +
                           unfinished.keep().string());
}

/** As the file has that is replaced. */
void takePermissions(const fs::path& target, int descriptor) {
  struct stat old {};
  if (stat(target.c_str(), &old) == 0) fchmod(descriptor, old.st_mode & 07777);
}

}  // namespace

StagedFile::StagedFile(fs::path target) : m_target(placeOf(target)) {
  try {
    m_unfinished = std::make_unique<Unfinished>(m_target.parent_path(), Unfinished::Kind::File,
                                                m_target.filename().string());
  } catch (const fs::filesystem_error& e) {
    const bool nowhere = e.code() == std::errc::no_such_file_or_directory;
    throw std::runtime_error(target.string() + ": cannot be written" +
                             (nowhere ? " (does the folder exist?)" : ": " + e.code().message()));
  }
  takePermissions(m_target, m_unfinished->descriptor());
}

StagedFile::~StagedFile() = default;

const fs::path& StagedFile::path() const { return m_unfinished->path(); }

void StagedFile::commit(Disk when) {
  const Move move = naming(m_target, [&] { return Move(path(), m_target); });
  const Descriptor folder = naming(m_target, [&] {  // what can fail comes first
    if (when == Disk::Now) synchronize(m_unfinished->descriptor());
    return openToSync(m_target.parent_path());
  });
  const auto held = Unfinished::hold();
  if (!naming(m_target, [&] { return move.take(); })) keep(m_target, *m_unfinished);
  if (when == Disk::Now) naming(m_target, [&] { synchronize(folder); });
}

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

void OutputFolder::commit(const std::vector<std::string>& names) {
  std::vector<Move> moves;  // what can fail comes first
  for (const std::string& name : names)
    naming(m_folder / name, [&] {
      checkPlace(m_folder / name);
      moves.emplace_back(staged(name), m_folder / name);
      if (fs::exists(staged(name))) synchronize(openToSync(staged(name)));
    });
  const Descriptor folder = naming(m_folder, [&] { return openToSync(m_folder); });
  flock(folder, LOCK_EX);  // of two at the same time, the files are of one
  const auto held = Unfinished::hold();
  for (const auto step : {&Move::isFree, &Move::take})
    for (const Move& move : moves)
      if (!naming(move.to(), [&] { return (move.*step)(); })) keep(move.to(), *m_staging);
  naming(m_folder, [&] { synchronize(folder); });
}

void declareNew(const fs::path& file) {
  const auto held = Unfinished::hold();
  newFiles().insert(keyOf(file));
}

namespace {

[[noreturn]] void fail(const fs::path& folder, const std::string& why) {
  throw std::runtime_error(folder.string() + ": scratch file cannot be made or used: " + why);
}

std::string reason() { return std::generic_category().message(errno); }

/** Calls f(bytes, size, place) until all is done. \return whether it was */
template <typename Bytes, typename F>
bool inPieces(Bytes* bytes, std::size_t size, std::uint64_t place, const F& f) {
  while (size > 0) {
    const ssize_t done = f(bytes, size, static_cast<off_t>(place));
    if (done < 0 && errno == EINTR) continue;
    if (done == 0) errno = EIO;
    if (done <= 0) return false;
    bytes += done;
    size -= static_cast<std::size_t>(done);
    place += static_cast<std::uint64_t>(done);
  }
  return true;
}

}  // namespace

ScratchFile::ScratchFile(const fs::path& folder) try
    : m_folder(folder),
      m_file(std::make_unique<Unfinished>(folder, Unfinished::Kind::File, "scratch")) {
} catch (const fs::filesystem_error& e) {
  fail(folder, e.code().message());
}

ScratchFile::~ScratchFile() = default;

std::uint64_t ScratchFile::append(const void* bytes, std::size_t size) {
  const std::uint64_t place = m_end;
  const int file = m_file->descriptor();
  if (!inPieces(static_cast<const char*>(bytes), size, place,
                [file](const char* b, std::size_t n, off_t at) { return pwrite(file, b, n, at); }))
    fail(m_folder, reason());
  m_end += size;
  return place;
}

void ScratchFile::read(std::uint64_t place, void* bytes, std::size_t size) const {
  const int file = m_file->descriptor();
  if (!inPieces(static_cast<char*>(bytes), size, place,
                [file](char* b, std::size_t n, off_t at) { return pread(file, b, n, at); }))
    fail(m_folder, reason());
}

void ScratchFile::discard(std::uint64_t place, std::size_t size) noexcept {
#ifdef FALLOC_FL_PUNCH_HOLE
  if (fallocate(m_file->descriptor(), FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE,
                static_cast<off_t>(place), static_cast<off_t>(size)) != 0)
    return;  // the file system has no holes: the file stays as large as it was
#endif
}

Descriptor::~Descriptor() {
  if (m_number >= 0) close(m_number);
}

namespace {

int operationOf(FileLock::Kind kind) { return kind == FileLock::Kind::Shared ? LOCK_SH : LOCK_EX; }

}  // namespace

FileLock::FileLock(const std::filesystem::path& file)
    : m_descriptor(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
  if (m_descriptor < 0 && (errno == EACCES || errno == EROFS))
    m_descriptor = Descriptor(open(file.c_str(), O_RDONLY | O_CLOEXEC));
}

FileLock::FileLock(const std::filesystem::path& file, Kind kind) : FileLock(file) {
  while (m_descriptor >= 0 && flock(m_descriptor, operationOf(kind)) != 0 && errno == EINTR) {
  }
}

std::optional<FileLock> FileLock::tryTo(const std::filesystem::path& file, Kind kind) {
  constexpr int kMost = 10;
  for (int i = 1;; ++i) {  // who held it may have taken the file along, so that others see another
    FileLock lock(file);
    const bool isScarce = errno == EMFILE || errno == ENFILE;  // it may be locked all the same
    if (lock.m_descriptor < 0) return isScarce ? std::nullopt : std::optional(std::move(lock));
    if (flock(lock.m_descriptor, operationOf(kind) | LOCK_NB) != 0)
      return errno == EWOULDBLOCK ? std::nullopt : std::optional(std::move(lock));
    if (leadsTo(file, lock.m_descriptor) || i == kMost) return lock;
  }
}

}  // namespace strict_files
