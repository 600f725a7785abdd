#include <map_streams/MapStream.h>
#include <zlib.h>

#include <cstring>
#include <stdexcept>

namespace semantic_octree {
namespace {

/** CRC-32 of all that follows (4 bytes), "SO", version, type (1 byte), stream (4 bytes). */
constexpr char kMark[] = {'S', 'O'};
constexpr std::uint8_t kStreamVersion = 2;
constexpr std::size_t kDatagramHeaderBytes = 12;

std::uint32_t crcOf(const std::string& bytes, std::size_t from) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data()) + from, bytes.size() - from));
}

}  // namespace

std::string Datagram::bytes() const {
  std::string bytes(kDatagramHeaderBytes, '\0');
  std::memcpy(&bytes[4], kMark, sizeof(kMark));
  bytes[6] = static_cast<char>(kStreamVersion);
  bytes[7] = static_cast<char>(type);
  std::memcpy(&bytes[8], &stream, sizeof(stream));
  bytes += payload;
  const std::uint32_t crc = crcOf(bytes, sizeof(crc));
  std::memcpy(&bytes[0], &crc, sizeof(crc));
  return bytes;
}

Datagram Datagram::of(const std::string& bytes) {
  if (bytes.size() < kDatagramHeaderBytes || bytes.size() > kMaxDatagramBytes ||
      std::memcmp(&bytes[4], kMark, sizeof(kMark)) != 0)
    throw std::runtime_error("a datagram of another program");
  std::uint32_t crc = 0;
  std::memcpy(&crc, &bytes[0], sizeof(crc));
  if (crc != crcOf(bytes, sizeof(crc)))
    throw std::runtime_error("altered: a datagram whose checksum does not match");
  if (const auto version = static_cast<std::uint8_t>(bytes[6]); version != kStreamVersion)
    throw std::runtime_error("a datagram of version " + std::to_string(version) +
                             " of the protocol, expected " + std::to_string(kStreamVersion));
  Datagram d;
  d.type = static_cast<Type>(bytes[7]);
  if (d.type < Type::Request || d.type > Type::Cookie)
    throw std::runtime_error("altered: a datagram of type " +
                             std::to_string(static_cast<std::uint8_t>(bytes[7])));
  std::memcpy(&d.stream, &bytes[8], sizeof(d.stream));
  d.payload = bytes.substr(kDatagramHeaderBytes);
  return d;
}

}  // namespace semantic_octree
