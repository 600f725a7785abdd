#include "GzipInputStream.h"

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <string_view>

namespace labeled_cloud {

namespace {

bool isZstandard(const std::filesystem::path& file) {
  char begin[4] = {};
  std::ifstream(file, std::ios::binary).read(begin, 4);
  return std::string_view(begin, 4) == "\x28\xb5\x2f\xfd";
}

}  // namespace

GzipInputStream::GzipInputStream(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file))
    throw std::runtime_error(file.string() + ": there is no such file");
  m_file.reset(gzopen(file.c_str(), "rb"));
  if (!m_file) throw std::runtime_error(file.string() + ": cannot be opened");
  if (isZstandard(file))
    throw std::runtime_error(file.string() + ": is compressed with Zstandard, expected gzip");
  gzbuffer(m_file.get(), 1u << 18);
  m_fileSize = std::filesystem::file_size(file);
}

std::size_t GzipInputStream::Read(void* buffer, std::size_t count) {
  std::size_t done = 0;
  while (done < count) {
    const std::size_t piece = std::min<std::size_t>(count - done, 1u << 30);
    const int got = gzread(m_file.get(), static_cast<char*>(buffer) + done, piece);
    noteDamage();
    if (got <= 0) break;
    done += got;
  }
  m_delivered += done;
  return done;
}

/** After each read: since zlib 1.3.2 the next one forgets it. */
void GzipInputStream::noteDamage() {
  int code = Z_OK;
  const char* message = gzerror(m_file.get(), &code);
  if (code == Z_BUF_ERROR) m_damage = "the compressed data is cut off";
  if (code != Z_BUF_ERROR && code != Z_OK) m_damage = message;
}

std::size_t GzipInputStream::Write(const void*, std::size_t) {
  throw std::logic_error("GzipInputStream: cannot be written to");
}

std::uint64_t GzipInputStream::Seek(std::int64_t, TSeekOrigin) {
  throw std::logic_error("GzipInputStream: cannot seek");
}

std::uint64_t GzipInputStream::getPosition() const {
  return std::clamp<std::int64_t>(gzoffset(m_file.get()), 0, m_fileSize);
}

}  // namespace labeled_cloud
