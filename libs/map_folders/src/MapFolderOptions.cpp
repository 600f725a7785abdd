#include <map_folders/MapFolder.h>

namespace semantic_octree {

using strict_files::above;
using strict_files::atLeast;

void MapFolderOptions::describe(strict_files::OptionList& list) {
  list.add("memory", memory, "MB", atLeast(0),
           "of tiles that are kept in memory; what one scan needs is always taken");
  list.add("tile_size", tileSize, "m", above(0),
           "edge of a new folder's tiles; the next smaller power of two voxels, 8 at least");
}

void MapFolderOptions::validate() const { strict_files::checkOptions(*this, "MapFolderOptions"); }

}  // namespace semantic_octree
