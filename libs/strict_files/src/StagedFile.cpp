#include <strict_files/OutputFiles.h>
#include <sys/stat.h>

#include <stdexcept>

#include "Placing.h"

namespace strict_files {

namespace fs = std::filesystem;

namespace {

/** What links lead to. \throw std::runtime_error nothing can be written there. */
fs::path placeOf(const fs::path& target) {
  const auto refuse = [&target](const std::string& why) {
    throw std::runtime_error(target.string() + ": cannot be written, " + why);
  };
  std::error_code error;
  const bool isLink = fs::is_symlink(target, error);
  const fs::path place = isLink ? fs::canonical(target, error) : target;
  if (isLink && error) refuse("it is a link that leads nowhere");
  const fs::file_status status = fs::status(place, error);
  if (fs::is_directory(status)) refuse("it is a folder");
  if (fs::exists(status) && !fs::is_regular_file(status)) refuse("it is no regular file");
  return place;
}

/** As the file has that is replaced. */
void takePermissions(const fs::path& target, int descriptor) {
  struct stat old {};
  if (stat(target.c_str(), &old) == 0) fchmod(descriptor, old.st_mode & 07777);
}

}  // namespace

StagedFile::StagedFile(fs::path target) : m_target(placeOf(target)) {
  try {
    m_unfinished = std::make_unique<Unfinished>(m_target.parent_path(), Unfinished::Kind::File,
                                                m_target.filename().string());
  } catch (const fs::filesystem_error& e) {
    const bool nowhere = e.code() == std::errc::no_such_file_or_directory;
    throw std::runtime_error(target.string() + ": cannot be written" +
                             (nowhere ? " (does the folder exist?)" : ": " + e.code().message()));
  }
  takePermissions(m_target, m_unfinished->descriptor());
}

StagedFile::~StagedFile() = default;

const fs::path& StagedFile::path() const { return m_unfinished->path(); }

void StagedFile::commit(Disk when) {
  try {
    const Placement placement(m_unfinished->path(), m_target);
    const OpenFolder folder(m_target.parent_path());
    if (when == Disk::Now) synchronize(m_unfinished->descriptor());
    const auto held = Unfinished::hold();
    placement.take();
    if (when == Disk::Now) folder.synchronize();
  } catch (const PlaceTaken& e) {
    const auto held = Unfinished::hold();
    keepAndReport(m_target, *m_unfinished, e);
  } catch (const fs::filesystem_error& e) {
    throw std::runtime_error(m_target.string() + ": cannot be written: " + e.code().message());
  } catch (const std::exception& e) {
    throw std::runtime_error(m_target.string() + ": cannot be written: " + e.what());
  }
}

}  // namespace strict_files
