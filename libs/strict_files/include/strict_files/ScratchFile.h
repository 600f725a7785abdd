#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

namespace strict_files {

class Unfinished;

/** Bytes that do not have to be in memory, in a file that goes with this object. What a killed
 * process left is removed by the next that writes into the same folder. */
class ScratchFile {
 public:
  /** \throw std::runtime_error the folder does not exist or cannot be written to. */
  explicit ScratchFile(const std::filesystem::path& folder);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /** \return where the bytes are \throw std::runtime_error naming the folder, if its disk is full
   */
  std::uint64_t append(const void* bytes, std::size_t size);
  /** \throw std::runtime_error naming the folder */
  void read(std::uint64_t place, void* bytes, std::size_t size) const;
  /** The bytes are not needed any more: gives their part of the disk back, where that can be. */
  void discard(std::uint64_t place, std::size_t size) noexcept;

 private:
  std::filesystem::path m_folder;
  std::unique_ptr<Unfinished> m_file;
  std::uint64_t m_end = 0;
};

}  // namespace strict_files
