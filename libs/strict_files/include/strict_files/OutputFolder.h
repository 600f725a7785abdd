#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace strict_files {

class Placement;
class Unfinished;

/** The folder of the results. Files are written into a folder inside it and take their place at the
 * end, all of them, when they are on the disk: what was there stays if anything fails. What killed
 * processes left of theirs is removed by the next one. */
class OutputFolder {
 public:
  /** Creates the folder, with those above it.
   * \throw std::runtime_error naming the folder, if it cannot be written to. */
  explicit OutputFolder(std::filesystem::path folder);
  /** Removes what was not committed. */
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /** Where to write a file. */
  std::filesystem::path staged(const std::string& name) const;
  /** The folder's lock (FileLock), held by this process, goes with what was not committed, if
   * nothing else is in the folder. */
  void takeAlong(const std::string& lock);
  /** Puts these files in place, in this order; may be called again with others. One that was not
   * written removes its predecessor, so that files of different maps are never side by side. \throw
   * std::runtime_error naming the file that cannot be written, or whose place something else has
   * that is no regular file, or that is there although it was to be new (declareNew()): then the
   * files that have no place are kept in a folder beside them, which is said. */
  void commit(const std::vector<std::string>& names);

 private:
  Placement prepare(const std::string& name) const;

  std::filesystem::path m_folder;
  std::unique_ptr<Unfinished> m_staging;
};

}  // namespace strict_files
