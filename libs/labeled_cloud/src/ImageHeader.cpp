#include "ImageHeader.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

namespace labeled_cloud {
namespace {

bool isIn(char c, char first, char last) { return c >= first && c <= last; }

}  // namespace

ImageHeader::ImageHeader(const std::filesystem::path& file)
    : m_fileSize(std::filesystem::file_size(file)) {
  std::ifstream stream(file, std::ios::binary);
  const auto read = [&](std::uintmax_t bytes) {
    const std::size_t before = m_bytes.size();
    m_bytes.resize(std::max<std::size_t>(before, std::min(m_fileSize, bytes)));
    stream.read(&m_bytes[before], static_cast<std::streamsize>(m_bytes.size() - before));
    m_bytes.resize(before + static_cast<std::size_t>(stream.gcount()));
  };
  read(1024);
  m_kind = kindOfBytes();
  if (m_kind == Kind::Tiff || m_kind == Kind::Jpeg) read(m_fileSize);  // it may stand anywhere
}

ImageHeader::Kind ImageHeader::kindOfBytes() const {
  if (is("DICM", 128)) return Kind::None;
  if (is("\x89PNG")) return Kind::Png;
  if (is("BM")) return Kind::Bmp;
  if (m_bytes.size() > 2 && m_bytes[0] == 'P' && isIn(m_bytes[1], '1', '6')) return Kind::Pnm;
  if (is(std::string("II*\0", 4)) || is(std::string("MM\0*", 4))) return Kind::Tiff;
  return is("\xff\xd8\xff") ? Kind::Jpeg : Kind::None;
}

std::uint64_t ImageHeader::number(std::size_t at, int bytes, bool isHighestFirst) const {
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) {
    const std::size_t from = at + static_cast<std::size_t>(isHighestFirst ? i : bytes - 1 - i);
    value = value << 8 | (from < m_bytes.size() ? static_cast<unsigned char>(m_bytes[from]) : 0);
  }
  return value;
}

/** The next number in a PNM file's text, outside of comments; at most ten digits. */
std::uint64_t ImageHeader::nextNumber(std::size_t& at) const {
  while (at < m_bytes.size() && !isIn(m_bytes[at], '0', '9'))
    at = m_bytes[at] == '#' ? std::min(m_bytes.find('\n', at), m_bytes.size()) : at + 1;
  std::uint64_t number = 0;
  for (; at < m_bytes.size() && isIn(m_bytes[at], '0', '9'); ++at)
    number = std::min<std::uint64_t>(10 * number + std::uint64_t(m_bytes[at] - '0'), 1u << 31);
  return number;
}

ImageHeader::Size ImageHeader::sizeOfPnm() const {
  std::size_t at = 2;
  const std::uint64_t columns = nextNumber(at);
  return {columns, nextNumber(at)};
}

/** From the first picture's list of fields (TIFF 6.0, section 2). Of a field twice, the larger. */
ImageHeader::Size ImageHeader::sizeOfTiff() const {
  constexpr std::uint64_t kColumns = 256, kRows = 257, kShort = 3, kFieldBytes = 12;
  const bool isHighestFirst = m_bytes[0] == 'M';
  const std::size_t list = number(4, 4, isHighestFirst);
  Size size;
  for (std::uint64_t i = 0; i < number(list, 2, isHighestFirst); ++i) {
    const std::size_t field = list + 2 + i * kFieldBytes;
    const std::uint64_t tag = number(field, 2, isHighestFirst);
    const int bytes = number(field + 2, 2, isHighestFirst) == kShort ? 2 : 4;
    const std::uint64_t value = number(field + 8, bytes, isHighestFirst);
    if (tag == kColumns) size.columns = std::max(size.columns, value);
    if (tag == kRows) size.rows = std::max(size.rows, value);
  }
  return size;
}

/** From the header of the frame (ITU-T T.81, B.2.2): it has one of the markers C0 to CF that is no
 * table. Markers 01 and D0 to D7 have no length; bytes between segments are skipped, as by libjpeg.
 */
ImageHeader::Size ImageHeader::sizeOfJpeg() const {
  for (std::size_t at = 2; at + 9 < m_bytes.size();) {
    const std::uint64_t marker = number(at + 1, 1, true);
    if (number(at, 1, true) != 0xff || marker == 0 || marker == 0xff) {
      ++at;
      continue;
    }
    const bool isTable = marker == 0xc4 || marker == 0xc8 || marker == 0xcc;
    if (marker >= 0xc0 && marker <= 0xcf && !isTable)
      return {number(at + 7, 2, true), number(at + 5, 2, true)};
    const bool hasLength = marker != 1 && (marker < 0xd0 || marker > 0xd7);
    at += 2 + (hasLength ? number(at + 2, 2, true) : 0);
  }
  return {};
}

/** Rows of a BMP file may be counted from above, by a negative number. */
ImageHeader::Size ImageHeader::size() const {
  const auto ofBmp = [this](std::size_t at) {
    const auto value = static_cast<std::int32_t>(number(at, 4, false));
    return static_cast<std::uint64_t>(std::abs(std::int64_t{value}));
  };
  switch (m_kind) {
    case Kind::Png:
      return {number(16, 4, true), number(20, 4, true)};
    case Kind::Bmp:
      return {ofBmp(18), ofBmp(22)};
    case Kind::Pnm:
      return sizeOfPnm();
    case Kind::Tiff:
      return sizeOfTiff();
    case Kind::Jpeg:
      return sizeOfJpeg();
    default:
      return {};
  }
}

/** Bytes hold eight packed pixels at most; zlib has 1032 of them in one (PNG, TIFF), BMP's runs
 * and JPEG's empty blocks 128. */
void ImageHeader::checkSize() const {
  const bool isPacked = m_kind == Kind::Png || m_kind == Kind::Tiff;
  const std::uint64_t mostEach = 8 * (isPacked ? 1032 : 128);
  const auto [columns, rows] = size();
  if (columns > 0 && rows > mostEach * m_fileSize / columns)
    throw std::runtime_error("says that it has " + std::to_string(columns) + " x " +
                             std::to_string(rows) + " pixels, more than its " +
                             std::to_string(m_fileSize) + " bytes can hold");
}

}  // namespace labeled_cloud
