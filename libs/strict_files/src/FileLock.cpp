#include <fcntl.h>
#include <strict_files/FileLock.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "Unfinished.h"

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

FileLock::~FileLock() {
  if (m_descriptor >= 0) close(m_descriptor);
}

FileLock::FileLock(FileLock&& o) noexcept : m_descriptor(std::exchange(o.m_descriptor, -1)) {}

FileLock& FileLock::operator=(FileLock o) noexcept {
  std::swap(m_descriptor, o.m_descriptor);
  return *this;
}

}  // namespace strict_files
