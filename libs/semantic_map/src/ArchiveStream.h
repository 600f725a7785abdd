#pragma once
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <stdexcept>
#include <streambuf>
#include <string>

namespace semantic_map {

/** An MRPT archive as the standard library's streams know it. Takes not a byte more from the
 * archive than is read. The archive must outlive it. */
class ArchiveStreambuf : public std::streambuf {
 public:
  explicit ArchiveStreambuf(mrpt::serialization::CArchive& archive) : m_archive(archive) {}

 protected:
  std::streamsize xsputn(const char* bytes, std::streamsize count) override {
    if (count > 0) m_archive.WriteBuffer(bytes, count);
    return count;
  }
  int_type overflow(int_type c) override {
    if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
    const char byte = traits_type::to_char_type(c);
    return xsputn(&byte, 1) == 1 ? c : traits_type::eof();
  }
  std::streamsize xsgetn(char* bytes, std::streamsize count) override {
    std::streamsize done = 0;
    if (count > 0 && gptr() < egptr()) bytes[done++] = *gptr(), gbump(1);
    return done < count ? done + m_archive.ReadBuffer(bytes + done, count - done) : done;
  }
  int_type underflow() override {
    if (m_archive.ReadBuffer(&m_byte, 1) != 1) return traits_type::eof();
    setg(&m_byte, &m_byte, &m_byte + 1);
    return traits_type::to_int_type(m_byte);
  }

 private:
  mrpt::serialization::CArchive& m_archive;
  char m_byte = 0;
};

/** A text as MRPT writes it. MRPT's own reader believes whatever length it meets: this one holds no
 * more memory than there are bytes. \throw std::runtime_error the archive ends within it. */
inline std::string readText(mrpt::serialization::CArchive& archive) {
  constexpr std::size_t kPiece = 4096;
  std::string text;
  for (std::size_t left = archive.ReadAs<std::uint32_t>(); left > 0;) {
    const std::size_t piece = std::min(left, kPiece), begin = text.size();
    text.resize(begin + piece);
    if (archive.ReadBuffer(&text[begin], piece) != piece)
      throw std::runtime_error("the archive ends within a text");
    left -= piece;
  }
  return text;
}

}  // namespace semantic_map
