#pragma once
#include <map_view/TileSet.h>
#include <mrpt_compat/Drawing.h>

#include <map>
#include <memory>
#include <vector>

#include "Layer.h"
#include "LiveMap.h"
#include "ViewWindow.h"

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

/** Open maps, which of them are shown, and how. One of them is the active one, which is asked,
 * compressed and planned upon. */
class Viewer {
 public:
  Viewer(ViewWindow& window, std::vector<std::unique_ptr<Layer>> layers,
         const Beginning& beginning);

  ViewWindow& window() { return m_window; }
  /** Another map, which is shown. */
  void add(std::unique_ptr<Layer> layer);
  /** Called after that. */
  void onAdded(const std::function<void()>& f) { m_onAdded.push_back(f); }
  std::size_t numLayers() const { return m_maps.size(); }
  const Layer& layer(std::size_t i) const { return *m_maps[i].layer; }
  /** The active one, and its tiles. */
  Layer& layer() { return *m_maps[m_active].layer; }
  TileScene& tiles() { return m_maps[m_active].tiles; }
  bool isShown(std::size_t layer) const { return m_maps[layer].isShown; }
  void setShown(std::size_t layer, bool isShown);
  /** Another map becomes the active one, and is shown. */
  void activate(std::size_t layer);
  /** Called after another map was activated. */
  void onActivated(const std::function<void()>& f) { m_onActivated.push_back(f); }

  const map_view::ViewStyle& style() const { return m_maps[m_active].layer->look().style(); }
  /** Sets the style of all maps; the hidden classes are those of the active one. */
  void setStyle(const map_view::ViewStyle& style);
  /** The leaves of the map's compressed tree, or, without one, of the map. */
  void showCompressed(const map_view::LiveCompression* compression);
  /** Cells in some boxes look otherwise from now on: the next frame shows that, if coarsely, those
   * after it all of it. */
  void changed(const std::vector<map_view::KeyBox>& boxes);
  /** All of the maps that are shown, from a direction; degrees. */
  void lookFrom(double azimuth, double elevation);
  /** FOLDER/STEM-1ENDING, -2, ..., the first that is not there. */
  static std::filesystem::path newFile(const std::filesystem::path& folder, const std::string& stem,
                                       const std::string& ending);
  /** Writes what the window shows into a new file. \return its path */
  std::filesystem::path savePicture(const std::filesystem::path& folder);
  /** Called before each frame. */
  void onFrame(const std::function<void()>& f) { m_onFrame.push_back(f); }

  /** A line below the map, and on the standard output. */
  void say(const std::string& text);
  /** Does it. If something goes wrong, says so, also on the standard error. */
  void attempt(const std::function<void()>& action);
  const std::string& said() const { return m_said; }

 private:
  struct OpenMap {
    std::unique_ptr<Layer> layer;
    TileScene tiles;
    bool isShown = true;
  };
  bool frame();
  void insertMaps();
  Eigen::AlignedBox3d extent() const;

  ViewWindow& m_window;
  std::vector<OpenMap> m_maps;
  std::size_t m_active = 0;
  std::vector<std::function<void()>> m_onActivated, m_onAdded, m_onFrame;
  std::string m_said, m_camera;
  bool m_hurries = false;
  double m_restAt = 0;  ///< s of GLFW's clock: the camera has come to rest
};

}  // namespace map_window
