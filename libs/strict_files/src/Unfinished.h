#pragma once
#include <strict_files/OutputFiles.h>

#include <filesystem>
#include <mutex>

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
  Descriptor m_descriptor{-1};
};

/** Whether a path leads to what is open. */
bool leadsTo(const std::filesystem::path& path, int descriptor);

/** Brings the content of a file or folder to the disk. \throw std::runtime_error saying why not */
void synchronize(int descriptor);

/** Opens what is there to read it, so that what happened to it can be brought to the disk.
 * \throw std::runtime_error saying why not */
Descriptor openToSync(const std::filesystem::path& path);

}  // namespace strict_files
