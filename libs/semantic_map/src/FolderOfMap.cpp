#include "FolderOfMap.h"

#include <stdexcept>

namespace semantic_map {

using semantic_octree::SemanticOcTree;

void CSemanticOctoMap::openFolder(const TFolderOptions& options) {
  checkMayBecomeAnother();
  useFilterOfOptions();
  m_folder = std::make_unique<Folder>(m_tree, options);
}

semantic_octree::MapFolder* CSemanticOctoMap::folder() const {
  return m_folder ? &m_folder->tiles : nullptr;
}

std::unique_lock<std::mutex> CSemanticOctoMap::reading() const {
  return m_folder ? std::unique_lock(m_folder->mutex) : std::unique_lock<std::mutex>();
}

bool CSemanticOctoMap::isEmpty() const {
  const auto lock = reading();
  return m_tree.empty();
}

SemanticOcTree CSemanticOctoMap::wholeTree() const {
  const auto lock = reading();
  return m_tree;
}

void CSemanticOctoMap::checkMayBecomeAnother() const {
  if (m_folder)
    throw std::logic_error(
        "a map in a folder of tiles cannot become another one, by assignment or from an archive");
}

}  // namespace semantic_map
