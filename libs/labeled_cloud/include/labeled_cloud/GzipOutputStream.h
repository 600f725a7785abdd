#pragma once
#include <mrpt/io/CStream.h>

#include <filesystem>

struct gzFile_s;  // zlib's

namespace labeled_cloud {

/** Writes a gzip file. Unlike MRPT's own stream it tells when the disk is full. */
class GzipOutputStream : public mrpt::io::CStream {
 public:
  /** \throw std::runtime_error naming the file, if it cannot be opened. */
  GzipOutputStream(const std::filesystem::path& file, int compression);
  ~GzipOutputStream() override;
  GzipOutputStream(const GzipOutputStream&) = delete;
  GzipOutputStream& operator=(const GzipOutputStream&) = delete;

  /** \throw std::runtime_error naming the file, if not everything can be written. */
  std::size_t Write(const void* buffer, std::size_t count) override;
  /** Writes what is left. \throw std::runtime_error as Write(). */
  void close();

  /** \throw std::logic_error always: this stream only writes, from the first byte to the last. */
  std::size_t Read(void*, std::size_t) override;
  std::uint64_t Seek(std::int64_t, TSeekOrigin) override;

  /** Bytes taken so far, before compression. */
  std::uint64_t getTotalBytesCount() const override { return m_taken; }
  std::uint64_t getPosition() const override { return m_taken; }

 private:
  [[noreturn]] void fail() const;

  std::filesystem::path m_path;
  gzFile_s* m_file = nullptr;
  std::uint64_t m_taken = 0;
};

}  // namespace labeled_cloud
