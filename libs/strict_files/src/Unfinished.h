#pragma once
#include <strict_files/OutputFiles.h>

#include <filesystem>
#include <mutex>
#include <stdexcept>

namespace strict_files {

/** A new file or folder that is to take a place of its own later. It is locked while somebody
 * writes it. So what a killed process left can be told from it, and the next that writes into the
 * same folder removes that. */
class Unfinished {
 public:
  enum class Kind { File, Folder };
  /** \param folder Where it is made, under a name that nothing has; made, too, for a Folder.
   * \param ending The end of its name, by which some writers know the format, and users the file.
   * \throw std::filesystem::filesystem_error it cannot be made. */
  Unfinished(const std::filesystem::path& folder, Kind kind, const std::string& ending = "");
  /** Removes it, if it is still there, and the folder if it was made here and is empty. */
  ~Unfinished();
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;

  const std::filesystem::path& path() const { return m_path; }
  /** Descriptor of the file or folder, open. */
  int descriptor() const { return m_descriptor; }

  /** A file beside it, a lock, goes with it if nothing else is left in the folder. */
  void takeAlong(const std::string& name) { m_companion = m_folder / name; }

  /** Gives it a name that stays, for the user: "kept-..." \return its path */
  std::filesystem::path keep();

  /** As long as this is held, leaveWithoutOutputs() waits. */
  static std::unique_lock<std::mutex> hold();

 private:
  friend void leaveWithoutOutputs(int status);
  bool make(Kind kind);
  bool lock();
  void discard() noexcept;

  std::filesystem::path m_folder, m_path, m_companion;
  bool m_madeFolder = false;
  int m_descriptor = -1;
};

/** Whether a path leads to what is open. */
bool leadsTo(const std::filesystem::path& path, int descriptor);

/** Brings the content of a file or folder to the disk. \throw std::runtime_error saying why not */
void synchronize(int descriptor);
/** Brings what a path names to the disk. */
void synchronize(const std::filesystem::path& path);

/** What was to be new is there. */
class PlaceTaken : public std::runtime_error {
 public:
  PlaceTaken() : std::runtime_error("somebody else has written it since this program began") {}
};

/** A file on its way to its name. What can fail for want of memory is done when it is made. */
class Placement {
 public:
  /** \param file empty: what is there is removed, unless it was to be new (declareNew()) */
  Placement(std::filesystem::path file, const std::filesystem::path& place);
  /** \throw PlaceTaken the file was to be new, and something is there. */
  void checkFree() const;
  /** Gives it its name. What is there is replaced, unless the file was to be new.
   * \throw PlaceTaken, std::filesystem::filesystem_error */
  void take() const;

 private:
  void takeNew() const;

  std::filesystem::path m_file, m_place, m_key;
  bool m_isNew;
};

/** A folder, open, so that what happened in it can be brought to the disk. */
class OpenFolder {
 public:
  /** \throw std::runtime_error saying why not */
  explicit OpenFolder(const std::filesystem::path& folder);
  ~OpenFolder();
  OpenFolder(const OpenFolder&) = delete;
  OpenFolder& operator=(const OpenFolder&) = delete;
  /** \throw std::runtime_error saying why not */
  void synchronize() const;
  int descriptor() const { return m_descriptor; }

 private:
  int m_descriptor;
};

/** Leaves it there for the user, and says where. */
[[noreturn]] void keepAndReport(const std::filesystem::path& target, Unfinished& unfinished,
                                const PlaceTaken& why);

}  // namespace strict_files
