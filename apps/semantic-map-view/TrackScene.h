#pragma once
#include "Track.h"
#include "map_window/Viewer.h"

namespace semantic_map_view {

using namespace map_window;

/** Trajectories and paths upon the maps. */
class TrackScene {
 public:
  explicit TrackScene(Viewer& viewer);
  TrackScene(const TrackScene&) = delete;
  TrackScene& operator=(const TrackScene&) = delete;

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

}  // namespace semantic_map_view
