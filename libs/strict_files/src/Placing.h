#pragma once
#include <strict_files/OutputFiles.h>

#include <stdexcept>

#include "Unfinished.h"

namespace strict_files {

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
