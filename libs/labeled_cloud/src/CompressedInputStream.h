#pragma once
#include <mrpt/io/CStream.h>
#include <zlib.h>

#include <filesystem>
#include <memory>
#include <string>

#include "ZstdFile.h"

namespace labeled_cloud {

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
