#pragma once
#include <mrpt_compat/Drawing.h>

#include "PlanPanel.h"
#include "Track.h"
#include "map_window/ViewWindow.h"
#include "map_window/Viewer.h"

namespace semantic_map_view {

/** m above the ground: of what is drawn upon the map. */
constexpr float kLift = 0.3f;

/** Some pixels where the window looks at now, m. */
float bandWidth(const map_window::ViewWindow& window);

/** Flat, with a light border: dark where it goes forward, orange backward, blue where that is not
 * known, as in the pictures of plans. (Many drivers draw lines one pixel wide whatever they are
 * asked for.) \param width m */
mrpt_compat::drawing::CSetOfTriangles::Ptr bandAlong(const std::vector<Track::Point>& points,
                                                     float width);

using namespace map_window;

/** Trajectories and paths upon the maps. */
class TrackScene {
 public:
  explicit TrackScene(Viewer& viewer);
  TrackScene(const TrackScene&) = delete;

  void add(Track track);
  std::size_t size() const { return m_tracks.size(); }
  const Track& track(std::size_t i) const { return m_tracks[i].track; }
  bool isShown(std::size_t i) const { return m_tracks[i].isShown; }
  void setShown(std::size_t i, bool isShown);

 private:
  struct Shown {
    Track track;
    bool isShown = true;
  };
  /** Before each frame: they stay as wide as they look. */
  void update();
  void draw();

  Viewer& m_viewer;
  std::vector<Shown> m_tracks;
  float m_width = 0;  ///< m, as they were drawn
  mrpt_compat::drawing::CSetOfObjects::Ptr m_bands = mrpt_compat::drawing::CSetOfObjects::Create();
};

/** Opens what is dropped onto the window: maps, what lies upon them, which it lists, and what paths
 * are planned by. */
class FilesPanel {
 public:
  FilesPanel(Viewer& viewer, TrackScene& tracks, PlanPanel& plan, const WantedTiles& wanted);
  FilesPanel(const FilesPanel&) = delete;

 private:
  /** Before the next frame: panels must not change while they handle what a hand does. */
  void openWanted();
  void open(const std::string& file);
  void listTracks();

  Viewer& m_viewer;
  TrackScene& m_tracks;
  PlanPanel& m_plan;
  const WantedTiles m_wantedTiles;
  Panel* m_panel;
  nanogui::Widget* m_list;
  std::vector<std::string> m_wanted;
};

}  // namespace semantic_map_view
