#pragma once
#include <map_view/TileSet.h>
#include <mrpt_compat/Drawing.h>

#include <map>

#include "Layer.h"

namespace map_window {

/** The tiles of a map in an MRPT scene. Meshes are made when they are first seen, and again only
 * where something changed. */
class TileScene {
 public:
  /** To be put into a scene: solid cells and, to be drawn after them, translucent ones. */
  const mrpt_compat::drawing::CSetOfObjects::Ptr& objects() const { return m_objects; }

  /** Brings the scene up to date with what is seen, for about so many milliseconds; what is not
   * ready shows as it was. \return whether all is ready */
  bool update(const Layer& layer, const map_view::View& view, double milliseconds);
  /** All cells look otherwise, or those in some boxes. */
  void touch() { m_fresh.clear(); }
  void touch(const std::vector<map_view::KeyBox>& boxes) { m_fresh.remove(boxes); }

 private:
  struct Meshes {
    struct Part {
      mrpt_compat::drawing::CSetOfTriangles::Ptr triangles;
      std::size_t faces = 0;
    };
    std::array<Part, map_view::kNumDirections> occupied;
    Part translucent;
    std::size_t faces() const;
  };
  void build(const Layer& layer, const map_view::Tile& tile);
  /** What stands for a tile: itself, or, as long as that is not ready, a coarser one around it that
   * is, or what there was. */
  map_view::Tile standIn(const map_view::Tile& tile) const;
  void show(const std::vector<map_view::Tile>& tiles, const map_view::OrbitCamera& camera,
            double voxelSize);
  void forgetUnseen(const std::vector<map_view::Tile>& seen);

  mrpt_compat::drawing::CSetOfObjects::Ptr m_objects =
      mrpt_compat::drawing::CSetOfObjects::Create();
  std::map<map_view::Tile, Meshes> m_meshes;
  map_view::FreshTiles m_fresh;
  std::size_t m_kept = 0;
};

}  // namespace map_window
