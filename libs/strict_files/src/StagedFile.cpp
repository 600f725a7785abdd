#include <strict_files/StagedFile.h>

#include <fstream>
#include <stdexcept>

namespace strict_files {

StagedFile::StagedFile(std::filesystem::path target)
    : m_target(std::move(target)), m_staged(m_target.string() + ".tmp") {
  if (std::filesystem::is_directory(m_target))
    throw std::runtime_error(m_target.string() + ": cannot be written, it is a folder");
  if (!std::ofstream(m_staged))
    throw std::runtime_error(m_target.string() + ": cannot be written (does the folder exist?)");
}

StagedFile::~StagedFile() {
  std::error_code ignored;
  if (!m_staged.empty()) std::filesystem::remove(m_staged, ignored);
}

void StagedFile::commit() {
  std::error_code error;
  std::filesystem::rename(m_staged, m_target, error);
  if (error) throw std::runtime_error(m_target.string() + ": " + error.message());
  m_staged.clear();
}

}  // namespace strict_files
