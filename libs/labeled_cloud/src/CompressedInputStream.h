#pragma once
#include <mrpt/io/CStream.h>
#include <zlib.h>
#include <zstd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

namespace labeled_cloud {

/** Reads a file that is compressed with Zstandard (RFC 8878), one frame after the other. */
class ZstdFile {
 public:
  /** Whether the file begins as such files do. */
  static bool isOne(const std::filesystem::path& file);

  /** \throw std::runtime_error naming the file, if it cannot be opened. */
  explicit ZstdFile(const std::filesystem::path& file);

  /** \return how many bytes came: fewer at the end, and where the file is damaged. */
  std::size_t read(char* buffer, std::size_t count);
  /** Bytes of the file taken so far, compressed. */
  std::uint64_t position() const { return m_loaded - (m_input.size - m_input.pos); }
  /** What is wrong with the data met so far, empty if nothing is. */
  const std::string& damage() const { return m_damage; }

 private:
  struct Free {
    void operator()(ZSTD_DStream* stream) const { ZSTD_freeDStream(stream); }
  };
  void load();

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
 * Unlike MRPT's own streams it tells a file that was cut off or altered from one that ends: after
 * the end of the data, damage() says what is wrong. It does not throw while reading, since MRPT
 * takes any exception in front of an object for the end of the file. */
class CompressedInputStream : public mrpt::io::CStream {
 public:
  /** \throw std::runtime_error naming the file, if it cannot be opened. */
  explicit CompressedInputStream(const std::filesystem::path& file);

  std::size_t Read(void* buffer, std::size_t count) override;
  /** \throw std::logic_error always: this stream only reads, from the first byte to the last. */
  std::size_t Write(const void*, std::size_t) override;
  std::uint64_t Seek(std::int64_t, TSeekOrigin) override;

  /** Size of the file, compressed. */
  std::uint64_t getTotalBytesCount() const override { return m_fileSize; }
  /** Bytes of the file taken so far, compressed. */
  std::uint64_t getPosition() const override;
  /** Bytes delivered so far. */
  std::uint64_t delivered() const { return m_delivered; }
  /** What is wrong with the compressed data met so far, empty if nothing is. */
  const std::string& damage() const { return m_zstd ? m_zstd->damage() : m_damage; }

 private:
  struct Close {
    void operator()(gzFile file) const { gzclose_r(file); }
  };
  std::size_t readGzip(char* buffer, std::size_t count);
  void noteDamage();

  std::unique_ptr<ZstdFile> m_zstd;         ///< of such a file
  std::unique_ptr<gzFile_s, Close> m_gzip;  ///< of any other
  std::uint64_t m_fileSize = 0, m_delivered = 0;
  std::string m_damage;
};

}  // namespace labeled_cloud
