#include "ZstdFile.h"

#include <new>
#include <stdexcept>
#include <string_view>

namespace labeled_cloud {

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
