#include "FolderOfMap.h"

#include <map_operations/MapOperations.h>
#include <semantic_abstraction/Abstraction.h>

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
  if (!m_folder) return m_tree;
  const auto lock = reading();
  m_folder->tiles.checkFits();
  SemanticOcTree whole = emptyLike(m_tree);
  copyTo(whole, m_tree);
  if (hasAbstraction(m_tree))
    semantic_octree::setAbstraction(whole, semantic_octree::Abstraction(m_folder->map).options());
  return whole;
}

void CSemanticOctoMap::checkMayBecomeAnother() const {
  if (m_folder)
    throw std::logic_error(
        "a map in a folder of tiles cannot become another one, by assignment or from an archive");
}

}  // namespace semantic_map
