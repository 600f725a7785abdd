#include "TrackScene.h"

#include "Band.h"

namespace semantic_map_view {

namespace {
/** Bands are made anew when they look so much wider or narrower. */
constexpr float kTolerance = 1.25f;
}  // namespace

TrackScene::TrackScene(Viewer& viewer) : m_viewer(viewer) {
  viewer.window().marks()->insert(m_bands);
  viewer.onFrame([this] { update(); });
}

void TrackScene::add(Track track) {
  m_tracks.push_back({std::move(track), true});
  draw();
}

void TrackScene::setShown(std::size_t i, bool isShown) {
  m_tracks[i].isShown = isShown;
  draw();
}

void TrackScene::update() {
  const float width = bandWidth(m_viewer.window());
  if (width > kTolerance * m_width || width < m_width / kTolerance) draw();
}

void TrackScene::draw() {
  m_width = bandWidth(m_viewer.window());
  m_bands->clear();
  for (const Shown& shown : m_tracks)
    if (shown.isShown) m_bands->insert(bandAlong(shown.track.points, m_width));
  m_viewer.window().redraw();
}

}  // namespace semantic_map_view
