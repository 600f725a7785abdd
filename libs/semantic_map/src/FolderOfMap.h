#pragma once
#include <semantic_abstraction/Abstraction.h>
#include <semantic_map/CSemanticOctoMap.h>

namespace semantic_map {

/** The folder of a map, with what those who only read the map may do to it: tiles come and go. */
struct CSemanticOctoMap::Folder {
  Folder(semantic_octree::SemanticOcTree& tree, const TFolderOptions& options)
      : map(tree),
        readOnly(options.readOnly),
        tiles(tree, options.folder, readOnly ? Access::Read : Access::Write, options.tiles) {}

  semantic_octree::SemanticOcTree compressed() {
    return semantic_octree::Abstraction(map).compressedMap();
  }
  /** What was opened to be read has nothing to save. */
  void save() {
    const std::lock_guard lock(mutex);
    if (!readOnly) tiles.save();
  }

  using Access = semantic_octree::MapFolder::Access;
  semantic_octree::SemanticOcTree& map;
  bool readOnly;
  semantic_octree::MapFolder tiles;
  std::mutex mutex;
};

}  // namespace semantic_map
