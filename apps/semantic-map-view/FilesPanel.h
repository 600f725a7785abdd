#pragma once
#include "PlanPanel.h"
#include "TrackScene.h"

namespace semantic_map_view {

/** Opens what is dropped onto the window or named in a field: maps, what lies upon them, and
 * what paths are planned by. */
class FilesPanel {
 public:
  FilesPanel(Viewer& viewer, TrackScene& tracks, PlanPanel& plan, const WantedTiles& wanted);
  FilesPanel(const FilesPanel&) = delete;

 private:
  /** Before the next frame: panels must not change while they handle what a hand does. */
  void want(const std::string& file);
  void openWanted();
  void open(const std::string& file);
  void listTracks();

  Viewer& m_viewer;
  TrackScene& m_tracks;
  PlanPanel& m_plan;
  const WantedTiles m_wantedTiles;
  nanogui::TextBox* m_field;
  nanogui::Widget* m_list;
  std::vector<std::string> m_wanted;
};

}  // namespace semantic_map_view
