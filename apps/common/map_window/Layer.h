#pragma once
#include <map_folders/MapFolder.h>
#include <map_view/CellSource.h>

#include <filesystem>
#include <memory>

namespace map_window {

/** How much of a map in a folder of tiles is opened. */
struct WantedTiles {
  double memory = semantic_octree::MapFolderOptions().memory;  ///< MB
  /** Tiles beside it stay where they are; m, map frame. */
  Eigen::AlignedBox3d box = map_view::ViewStyle::everywhere();
};

/** A map that is open. */
class Layer {
 public:
  /** A map's own file, OctoMap's, or a folder of tiles.
   * \throw std::runtime_error naming the file and what is wrong, or it takes more memory. */
  explicit Layer(const std::filesystem::path& file, const WantedTiles& wanted = {});
  /** One that a program makes. It must outlive the layer; grown() says that it has changed. */
  Layer(const std::string& name, const semantic_octree::SemanticOcTree& map);
  void grown();

  const std::string& name() const { return m_name; }
  const semantic_octree::SemanticOcTree& map() const { return *m_map; }
  /** The map that was opened. */
  semantic_octree::SemanticOcTree& ownMap() { return *m_own; }
  const map_view::CellSource& cells() const { return m_cells; }
  map_view::CellLook& look() { return m_look; }
  const map_view::CellLook& look() const { return m_look; }
  /** \param compression whose cells these are from now on; null: of the map itself */
  void showCompressed(const map_view::LiveCompression* compression) {
    m_cells = map_view::CellSource(*m_map, compression);
    m_look.setCompression(compression);
  }

  /** K + 1 numbers of occupied leaves by their likeliest class. */
  const std::vector<std::size_t>& leavesOfClass() const { return m_leavesOfClass; }
  /** Nearly all that is occupied, m: a few of a thousand leaves far away do not count. */
  const Eigen::AlignedBox3d& extent() const { return m_extent; }

 private:
  void count();

  std::string m_name;
  std::unique_ptr<semantic_octree::SemanticOcTree> m_own;
  const semantic_octree::SemanticOcTree* m_map;
  map_view::CellLook m_look;
  map_view::CellSource m_cells;
  std::vector<std::size_t> m_leavesOfClass;
  Eigen::AlignedBox3d m_extent;
};

}  // namespace map_window
