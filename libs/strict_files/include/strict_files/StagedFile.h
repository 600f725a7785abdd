#pragma once
#include <filesystem>

namespace strict_files {

/** A file that is written beside its place and takes its name only when it is complete, so that
 * what was there stays if anything fails. */
class StagedFile {
 public:
  /** \throw std::runtime_error the target's folder does not exist or cannot be written to. */
  explicit StagedFile(std::filesystem::path target);
  /** Removes what was written, unless commit() was called. */
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  /** Where to write: the target's path with ".tmp" behind it. */
  const std::filesystem::path& path() const { return m_staged; }
  /** Gives the closed file its name. \throw std::runtime_error naming the target. */
  void commit();

 private:
  std::filesystem::path m_target, m_staged;
};

}  // namespace strict_files
