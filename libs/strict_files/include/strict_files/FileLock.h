#pragma once
#include <filesystem>
#include <optional>

namespace strict_files {

/** A lock between processes (flock), held as long as this lives, or as the process does. The file
 * is made if need be. Where the file system has no locks, or the file cannot be made,
 * everybody gets it. */
class FileLock {
 public:
  enum class Kind { Shared, Exclusive };
  /** Waits for it. */
  FileLock(const std::filesystem::path& file, Kind kind);
  /** \return nothing if somebody holds it, or may, as this process has too many files open */
  static std::optional<FileLock> tryTo(const std::filesystem::path& file, Kind kind);
  ~FileLock();
  FileLock(FileLock&& o) noexcept;
  FileLock& operator=(FileLock o) noexcept;

 private:
  explicit FileLock(const std::filesystem::path& file);

  int m_descriptor;
};

}  // namespace strict_files
