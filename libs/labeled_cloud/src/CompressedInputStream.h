#pragma once
#include <strict_files/Memory.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace labeled_cloud {

/** Reads a file that is compressed with Zstandard (RFC 8878), one frame after the other. */
class ZstdFile {
 public:
  /** Whether the file begins as such files do. */
  static bool isOne(const std::filesystem::path& file) {
    char begin[4] = {};
    std::ifstream(file, std::ios::binary).read(begin, 4);
    return std::string_view(begin, 4) == "\x28\xb5\x2f\xfd";
  }

  /** \throw std::runtime_error naming the file, if it cannot be opened. */
  explicit ZstdFile(const std::filesystem::path& file)
      : m_file(file, std::ios::binary),
        m_stream(ZSTD_createDStream()),
        m_piece(ZSTD_DStreamInSize()) {
    if (!m_file) throw std::runtime_error(file.string() + ": cannot be opened");
    if (!m_stream) throw std::bad_alloc();
  }

  /** \return how many bytes came: fewer at the end, and where the file is damaged. */
  std::size_t read(char* buffer, std::size_t count) {
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
  /** Bytes of the file taken so far, compressed. */
  std::uint64_t position() const { return m_loaded - (m_input.size - m_input.pos); }
  /** What is wrong with the data met so far, empty if nothing is. */
  const std::string& damage() const { return m_damage; }

 private:
  struct Free {
    void operator()(ZSTD_DStream* stream) const { ZSTD_freeDStream(stream); }
  };
  void load() {
    m_file.read(m_piece.data(), static_cast<std::streamsize>(m_piece.size()));
    m_input = {m_piece.data(), static_cast<std::size_t>(m_file.gcount()), 0};
    m_loaded += m_input.size;
  }

  std::ifstream m_file;
  std::unique_ptr<ZSTD_DStream, Free> m_stream;
  std::vector<char> m_piece;
  ZSTD_inBuffer m_input{nullptr, 0, 0};
  std::uint64_t m_loaded = 0;
  bool m_frameIsWhole = true;
  std::string m_damage;
};

/** Reads a file compressed with gzip or, as later releases of MRPT write them, with Zstandard; a
 * plain one as it is.
 *
 * Unlike MRPT's streams it tells a file that was cut off or altered from one that ends: damage()
 * says so afterwards. It does not throw while reading, since MRPT takes any exception in front of
 * an object for the end of the file. */
class CompressedInputStream {
 public:
  /** \throw std::runtime_error naming the file, if it cannot be opened. */
  explicit CompressedInputStream(const std::filesystem::path& file) : m_file(file) {
    if (!std::filesystem::is_regular_file(file))
      throw std::runtime_error(file.string() + ": there is no such file");
    if (ZstdFile::isOne(file)) {
      m_zstd = std::make_unique<ZstdFile>(file);
      return;
    }
    m_gzip.reset(gzopen(file.c_str(), "rb"));
    if (!m_gzip) throw std::runtime_error(file.string() + ": cannot be opened");
    gzbuffer(m_gzip.get(), 1u << 18);
  }

  /** \return how many bytes came: fewer at the end, and where the file is damaged. */
  std::size_t read(char* buffer, std::size_t count) {
    const std::size_t done = m_zstd ? m_zstd->read(buffer, count) : readGzip(buffer, count);
    m_delivered += done;
    return done;
  }
  /** Bytes of the file taken so far, compressed. */
  std::uint64_t position() const {
    return m_zstd ? m_zstd->position() : std::max<std::int64_t>(gzoffset(m_gzip.get()), 0);
  }
  /** Whether a piece of memory is in proportion to the file, for the object that is read next. */
  strict_files::AllocationLimit::Allows& allows() {
    m_small = 0;
    m_begin = m_delivered;
    return m_allows;
  }
  /** What is wrong with the compressed data met so far, empty if nothing is. */
  const std::string& damage() const { return m_zstd ? m_zstd->damage() : m_damage; }

 private:
  struct Close {
    void operator()(gzFile file) const { gzclose_r(file); }
  };
  std::size_t readGzip(char* buffer, std::size_t count) {
    const std::size_t done = gzfread(buffer, 1, count, m_gzip.get());
    // After each read: since zlib 1.3.2 the next one forgets it.
    int code = Z_OK;
    const char* message = gzerror(m_gzip.get(), &code);
    if (code == Z_BUF_ERROR) m_damage = "the compressed data is cut off";
    if (code != Z_BUF_ERROR && code != Z_OK) m_damage = message;
    return done;
  }
  bool isInProportion(std::size_t piece);
  bool unpacksTo(std::uint64_t size);

  std::filesystem::path m_file;
  std::unique_ptr<ZstdFile> m_zstd;         ///< of such a file
  std::unique_ptr<gzFile_s, Close> m_gzip;  ///< of any other
  std::string m_damage;
  std::uint64_t m_delivered = 0;                   ///< bytes of the file, unpacked
  std::unique_ptr<CompressedInputStream> m_ahead;  ///< looks how much there is
  std::uint64_t m_begin = 0;                       ///< where the object begins
  std::uint64_t m_small = 0;  ///< in all of the object's pieces that are not large
  strict_files::AllocationLimit::Allows m_allows = [this](std::size_t piece) {
    return isInProportion(piece);
  };
};

}  // namespace labeled_cloud
