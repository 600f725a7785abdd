#pragma once
#include <map_folders/MapFolder.h>
#include <map_view/CellSource.h>

namespace map_window {

/** How much of a map in a folder of tiles is opened. */
struct WantedTiles {
  double memory = semantic_octree::MapFolderOptions().memory;  ///< MB
  /** Tiles beside it stay where they are; m, map frame. */
  Eigen::AlignedBox3d box = map_view::ViewStyle::everywhere();
};

struct OpenedMap {
  semantic_octree::SemanticOcTree map;
  std::string note;  ///< what there is to say of it
};

/** A map's own file, OctoMap's, or a folder of tiles. What of the latter takes more memory than is
 * wanted is opened as if its voxels had 2, 4, 8 ... times their edge: the finest that fits.
 * \throw std::runtime_error naming the file and what is wrong. */
OpenedMap openMap(const std::filesystem::path& file, const WantedTiles& wanted = {});

}  // namespace map_window
