#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace strict_files {

class Unfinished;

/** A file that is written beside its place and takes its name only when it is complete and on the
 * disk. What was there stays if anything fails. If others write the file, too, it is whole: the
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

/** The folder of the results. Files are written into a folder inside it. All of them take their
 * place at the end, when they are on the disk; what was there stays if anything fails. What killed
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
   * std::runtime_error naming the file. It cannot be written, something that is no regular file has
   * its place, or it is there although it was to be new (declareNew()). Then the files that have no
   * place are kept in a folder beside them, which is said. */
  void commit(const std::vector<std::string>& names);

 private:
  std::filesystem::path m_folder;
  std::unique_ptr<Unfinished> m_staging;
};

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

/** Says that a file is to be new: what others put there from now on is not replaced by this process
 * (StagedFile, OutputFolder). Its own is, once it has its place. */
void declareNew(const std::filesystem::path& file);

/** Ends the process at once, as _exit() does, after it removed all files and folders that it began
 * (StagedFile, OutputFolder) and that have not taken their place. For programs that are told to
 * leave; any thread may call it, but no handler of a signal. */
[[noreturn]] void leaveWithoutOutputs(int status);

/** A file or folder that is open, and closed with this object. */
class Descriptor {
 public:
  explicit Descriptor(int number) : m_number(number) {}
  ~Descriptor();
  Descriptor(Descriptor&& o) noexcept : m_number(std::exchange(o.m_number, -1)) {}
  Descriptor& operator=(Descriptor o) noexcept {
    std::swap(m_number, o.m_number);
    return *this;
  }
  operator int() const { return m_number; }

 private:
  int m_number;  ///< below 0: it could not be opened
};

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

 private:
  explicit FileLock(const std::filesystem::path& file);

  Descriptor m_descriptor;
};

}  // namespace strict_files
