#include <strict_files/OutputFolder.h>

#include <cstdlib>
#include <stdexcept>

namespace strict_files {

namespace fs = std::filesystem;

OutputFolder::OutputFolder(fs::path folder) : m_folder(std::move(folder)) {
  std::error_code error;
  m_createdFolder = fs::create_directories(m_folder, error);
  std::string pattern = (m_folder / ".unfinished-XXXXXX").string();
  if (error || !mkdtemp(pattern.data()))
    throw std::runtime_error(m_folder.string() + ": cannot write into this folder" +
                             (error ? ": " + error.message() : ""));
  m_staging = pattern;
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  fs::remove_all(m_staging, ignored);
  if (m_createdFolder) fs::remove(m_folder, ignored);  // only if it is empty
}

void OutputFolder::commit(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    std::error_code error;
    if (fs::exists(staged(name)))
      fs::rename(staged(name), m_folder / name, error);
    else
      fs::remove(m_folder / name, error);
    if (error)
      throw std::runtime_error((m_folder / name).string() +
                               ": cannot be written: " + error.message());
  }
}

}  // namespace strict_files
