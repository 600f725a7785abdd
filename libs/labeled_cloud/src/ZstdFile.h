#pragma once
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

}  // namespace labeled_cloud
