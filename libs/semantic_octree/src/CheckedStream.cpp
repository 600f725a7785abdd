#include <semantic_octree/store/CheckedStream.h>

#include <zlib.h>

#include <cerrno>
#include <cstring>

namespace semantic_octree {

std::uint32_t extendCrc(std::uint32_t crc, const void* bytes, std::size_t size) {
  return static_cast<std::uint32_t>(crc32_z(crc, static_cast<const unsigned char*>(bytes), size));
}

void CheckedWriter::put(const std::string& text) {
  if (text.size() > UINT16_MAX)
    throw std::runtime_error("a name of " + std::to_string(text.size()) +
                             " characters is too long for a map file");
  put(static_cast<std::uint16_t>(text.size()));
  for (const char c : text) put(c);
}

void CheckedWriter::flush() {
  const std::uint32_t length = static_cast<std::uint32_t>(m_used);
  m_crc = extendCrc(extendCrc(m_crc, &length, sizeof(length)), m_block.data(), m_used);
  m_out.write(reinterpret_cast<const char*>(&length), sizeof(length));
  m_out.write(reinterpret_cast<const char*>(&m_crc), sizeof(m_crc));
  m_out.write(m_block.data(), static_cast<std::streamsize>(m_used));
  m_used = 0;
}

std::uint32_t CheckedWriter::finish() {
  if (m_used > 0) flush();
  flush();
  if (!m_out)
    throw std::runtime_error("the map could not be written completely: " +
                             std::string(std::strerror(errno)));
  return m_crc;
}

std::string CheckedReader::getText() {
  std::string text(get<std::uint16_t>(), '\0');
  for (char& c : text) c = get<char>();
  return text;
}

void CheckedReader::getAcrossBlocks(char* to, std::size_t bytes) {
  while (bytes > 0) {
    if (m_next == m_size) {
      nextBlock();
      if (m_size == 0) throw std::runtime_error("altered: its content ends too early");
    }
    const std::size_t part = std::min(bytes, m_size - m_next);
    std::memcpy(to, m_block.data() + m_next, part);
    m_next += part, to += part, bytes -= part;
  }
}

void CheckedReader::nextBlock() {
  std::uint32_t length = 0, crc = 0;
  readBytes(m_in, reinterpret_cast<char*>(&length), sizeof(length));
  readBytes(m_in, reinterpret_cast<char*>(&crc), sizeof(crc));
  if (length > kMaxBlockBytes)
    throw std::runtime_error("altered: a block of " + std::to_string(length) + " bytes");
  readBytes(m_in, m_block.data(), length);
  m_crc = extendCrc(extendCrc(m_crc, &length, sizeof(length)), m_block.data(), length);
  if (m_crc != crc) throw std::runtime_error("altered: a checksum does not match");
  m_next = 0;
  m_size = length;
}

void CheckedReader::finish() {
  if (m_next == m_size) nextBlock();
  if (m_size > 0) throw std::runtime_error("altered: more content than its counts tell");
}

void readBytes(std::istream& in, char* to, std::size_t bytes) {
  in.read(to, static_cast<std::streamsize>(bytes));
  if (static_cast<std::size_t>(in.gcount()) != bytes) throw std::runtime_error("truncated");
}

}  // namespace semantic_octree
