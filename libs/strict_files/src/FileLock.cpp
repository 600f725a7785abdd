#include <fcntl.h>
#include <strict_files/FileLock.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace strict_files {
namespace {

int operationOf(FileLock::Kind kind) { return kind == FileLock::Kind::Shared ? LOCK_SH : LOCK_EX; }

}  // namespace

FileLock::FileLock(const std::filesystem::path& file)
    : m_descriptor(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
  if (m_descriptor < 0) m_descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
}

FileLock::FileLock(const std::filesystem::path& file, Kind kind) : FileLock(file) {
  while (m_descriptor >= 0 && flock(m_descriptor, operationOf(kind)) != 0 && errno == EINTR) {
  }
}

std::optional<FileLock> FileLock::tryTo(const std::filesystem::path& file, Kind kind) {
  FileLock lock(file);
  if (lock.m_descriptor >= 0 && flock(lock.m_descriptor, operationOf(kind) | LOCK_NB) != 0 &&
      errno == EWOULDBLOCK)
    return std::nullopt;
  return lock;
}

FileLock::~FileLock() {
  if (m_descriptor >= 0) close(m_descriptor);
}

FileLock::FileLock(FileLock&& o) noexcept : m_descriptor(std::exchange(o.m_descriptor, -1)) {}

FileLock& FileLock::operator=(FileLock o) noexcept {
  std::swap(m_descriptor, o.m_descriptor);
  return *this;
}

}  // namespace strict_files
