#include <fcntl.h>
#include <strict_files/OutputFiles.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "Unfinished.h"

namespace strict_files {

namespace fs = std::filesystem;

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

}  // namespace strict_files
