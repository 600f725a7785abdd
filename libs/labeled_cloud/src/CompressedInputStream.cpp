#include "CompressedInputStream.h"

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string_view>

namespace labeled_cloud {

CompressedInputStream::CompressedInputStream(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file))
    throw std::runtime_error(file.string() + ": there is no such file");
  m_fileSize = std::filesystem::file_size(file);
  if (ZstdFile::isOne(file)) {
    m_zstd = std::make_unique<ZstdFile>(file);
    return;
  }
  m_gzip.reset(gzopen(file.c_str(), "rb"));
  if (!m_gzip) throw std::runtime_error(file.string() + ": cannot be opened");
  gzbuffer(m_gzip.get(), 1u << 18);
}

std::size_t CompressedInputStream::Read(void* buffer, std::size_t count) {
  char* const bytes = static_cast<char*>(buffer);
  const std::size_t done = m_zstd ? m_zstd->read(bytes, count) : readGzip(bytes, count);
  m_delivered += done;
  return done;
}

std::size_t CompressedInputStream::readGzip(char* buffer, std::size_t count) {
  std::size_t done = 0;
  while (done < count) {
    const std::size_t piece = std::min<std::size_t>(count - done, 1u << 30);
    const int got = gzread(m_gzip.get(), buffer + done, piece);
    noteDamage();
    if (got <= 0) break;
    done += got;
  }
  return done;
}

/** After each read: since zlib 1.3.2 the next one forgets it. */
void CompressedInputStream::noteDamage() {
  int code = Z_OK;
  const char* message = gzerror(m_gzip.get(), &code);
  if (code == Z_BUF_ERROR) m_damage = "the compressed data is cut off";
  if (code != Z_BUF_ERROR && code != Z_OK) m_damage = message;
}

std::size_t CompressedInputStream::Write(const void*, std::size_t) {
  throw std::logic_error("CompressedInputStream: cannot be written to");
}

std::uint64_t CompressedInputStream::Seek(std::int64_t, TSeekOrigin) {
  throw std::logic_error("CompressedInputStream: cannot seek");
}

std::uint64_t CompressedInputStream::getPosition() const {
  if (m_zstd) return m_zstd->position();
  return std::clamp<std::int64_t>(gzoffset(m_gzip.get()), 0, m_fileSize);
}

bool ZstdFile::isOne(const std::filesystem::path& file) {
  char begin[4] = {};
  std::ifstream(file, std::ios::binary).read(begin, 4);
  return std::string_view(begin, 4) == "\x28\xb5\x2f\xfd";
}

ZstdFile::ZstdFile(const std::filesystem::path& file)
    : m_file(file, std::ios::binary),
      m_stream(ZSTD_createDStream()),
      m_piece(ZSTD_DStreamInSize()) {
  if (!m_file) throw std::runtime_error(file.string() + ": cannot be opened");
  if (!m_stream) throw std::bad_alloc();
}

void ZstdFile::load() {
  m_file.read(m_piece.data(), static_cast<std::streamsize>(m_piece.size()));
  m_input = {m_piece.data(), static_cast<std::size_t>(m_file.gcount()), 0};
  m_loaded += m_input.size;
}

std::size_t ZstdFile::read(char* buffer, std::size_t count) {
  ZSTD_outBuffer output{buffer, count, 0};
  while (output.pos < count && m_damage.empty()) {
    if (m_input.pos == m_input.size) load();
    const std::size_t taken = m_input.pos, given = output.pos;
    const std::size_t left = ZSTD_decompressStream(m_stream.get(), &output, &m_input);
    if (ZSTD_isError(left)) {
      m_damage = ZSTD_getErrorName(left);
    } else if (m_input.pos == taken && output.pos == given) {  // the end of the file
      if (!m_frameIsWhole) m_damage = "the compressed data is cut off";
      break;
    } else {
      m_frameIsWhole = left == 0;
    }
  }
  return output.pos;
}

}  // namespace labeled_cloud
