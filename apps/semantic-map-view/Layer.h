#pragma once
#include <map_view/CellSource.h>

#include <filesystem>
#include <memory>

namespace semantic_map_view {

/** A map that is open. */
class Layer {
 public:
  /** A map's own file, or OctoMap's. \throw std::runtime_error naming the file and what is wrong.
   */
  explicit Layer(const std::filesystem::path& file);

  const std::string& name() const { return m_name; }
  semantic_octree::SemanticOcTree& map() { return *m_map; }
  const semantic_octree::SemanticOcTree& map() const { return *m_map; }
  const map_view::CellSource& cells() const { return *m_cells; }
  map_view::CellLook& look() { return m_look; }
  const map_view::CellLook& look() const { return m_look; }
  void setCells(std::unique_ptr<map_view::CellSource> cells) { m_cells = std::move(cells); }

  /** K + 1 numbers of occupied leaves by their likeliest class. */
  const std::vector<std::size_t>& leavesOfClass() const { return m_leavesOfClass; }
  /** Nearly all that is occupied, m: a few of a thousand leaves far away do not count. */
  const Eigen::AlignedBox3d& extent() const { return m_extent; }

 private:
  void count();

  std::string m_name;
  std::unique_ptr<semantic_octree::SemanticOcTree> m_map;
  map_view::CellLook m_look;
  std::unique_ptr<map_view::CellSource> m_cells;
  std::vector<std::size_t> m_leavesOfClass;
  Eigen::AlignedBox3d m_extent;
};

}  // namespace semantic_map_view
