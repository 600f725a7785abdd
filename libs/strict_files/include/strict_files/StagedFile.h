#pragma once
#include <filesystem>
#include <memory>

namespace strict_files {

class Unfinished;

/** A file that is written beside its place and takes its name only when it is complete and on the
 * disk, so that what was there stays if anything fails, and is whole if others write it, too: the
 * last to commit wins. What a killed process left of its own is removed by the next one. */
class StagedFile {
 public:
  /** \param target Its permissions stay if it is there. A link stays: what it leads to is written.
   * \throw std::runtime_error the target's folder does not exist or cannot be written to; the
   * target is there, and no regular file: devices, pipes and folders are never replaced. */
  explicit StagedFile(std::filesystem::path target);
  /** Removes what was written, unless commit() was called. */
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  /** Where to write: an empty file in the target's folder, with a name that nothing else has and
   * that ends like the target's. Writers fill this file, they do not replace it. */
  const std::filesystem::path& path() const;
  /** Gives the closed file its name. \throw std::runtime_error naming the target; if it was to be
   * new (declareNew()) and is there, what was written is kept under another name, which is said. */
  void commit() { commit(Disk::Now); }
  /** Later: it takes its name at once, for what OutputFolder has on the disk before it counts. */
  enum class Disk { Now, Later };
  void commit(Disk when);

 private:
  std::filesystem::path m_target;
  std::unique_ptr<Unfinished> m_unfinished;
};

}  // namespace strict_files
