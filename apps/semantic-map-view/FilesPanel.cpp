#include "FilesPanel.h"

#include <map_pictures/MapCanvas.h>
#include <strict_files/OptionList.h>

#include <cmath>
#include <utility>

#include "map_window/Widgets.h"

namespace semantic_map_view {

using map_pictures::Color;
using mrpt::math::TPoint3Df;
using mrpt_compat::drawing::CSetOfTriangles;
using mrpt_compat::drawing::TTriangle;

namespace {

constexpr Color kForward{20, 20, 20}, kBackward{230, 159, 0}, kEitherWay{0, 114, 178};
/** Shares of the width: the border on each side, and how much lower it lies. */
constexpr float kBorder = 0.25f, kBelow = 0.05f;

Color colorFor(Track::Gear gear) {
  if (gear == Track::Gear::Unknown) return kEitherWay;
  return gear == Track::Gear::Forward ? kForward : kBackward;
}

/** Without what is too near to the last one to be seen. */
std::vector<Track::Point> thinned(const std::vector<Track::Point>& points, double least) {
  std::vector<Track::Point> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool turns = i + 1 == points.size() || points[i + 1].gear != points[i].gear;
    if (kept.empty() || turns || (points[i].place - kept.back().place).norm() >= least)
      kept.push_back(points[i]);
  }
  return kept;
}

void addPiece(CSetOfTriangles& band, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
              float width, float lift, const Color& color) {
  const Eigen::Vector2d along = (to - from).head<2>();
  if (along.norm() < 1e-6) return;
  const Eigen::Vector2d side = width / 2 / along.norm() * Eigen::Vector2d(-along.y(), along.x());
  const TPoint3Df a(float(from.x()), float(from.y()), float(from.z()) + lift),
      b(float(to.x()), float(to.y()), float(to.z()) + lift),
      aside(float(side.x()), float(side.y()), 0);
  for (TTriangle half :
       {TTriangle(a - aside, b - aside, b + aside), TTriangle(a - aside, b + aside, a + aside)}) {
    half.setColor(mrpt::img::TColor(color.r, color.g, color.b));
    band.insertTriangle(half);
  }
}

}  // namespace

float bandWidth(const map_window::ViewWindow& window) {
  return std::max(0.3f, float(window.orbitCamera().distance) / 200);
}

CSetOfTriangles::Ptr bandAlong(const std::vector<Track::Point>& points, float width) {
  const auto band = CSetOfTriangles::Create();
  const auto places = thinned(points, width / 2);
  for (std::size_t i = 1; i < places.size(); ++i) {
    const auto &from = places[i - 1].place, &to = places[i].place;
    addPiece(*band, from, to, width * (1 + 2 * kBorder), kLift, map_pictures::kHalo);
    addPiece(*band, from, to, width, kLift + kBelow * width, colorFor(places[i].gear));
  }
  band->enableLight(false);
  return band;
}

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

namespace {
constexpr int kFilesWidth = 230;
}

FilesPanel::FilesPanel(Viewer& viewer, TrackScene& tracks, PlanPanel& plan,
                       const WantedTiles& wanted)
    : m_viewer(viewer),
      m_tracks(tracks),
      m_plan(plan),
      m_wantedTiles(wanted),
      m_panel(viewer.window().addPanel(ViewWindow::Side::Left, "Files", kFilesWidth)) {
  m_list = addScroll(m_panel->content(), kFilesWidth, 40);
  listTracks();
  viewer.window().addDropFilesCallback([this](const std::vector<std::string>& files) {
    m_wanted.insert(m_wanted.end(), files.begin(), files.end());
    m_viewer.window().redraw();
    return true;
  });
  viewer.onFrame([this] { openWanted(); });
}

void FilesPanel::openWanted() {
  for (const std::string& file : std::exchange(m_wanted, {})) m_viewer.attempt([&] { open(file); });
}

void FilesPanel::open(const std::string& file) {
  std::string text = "opened " + file + ": ";
  if (std::filesystem::path(file).extension() == ".yaml") {
    text += m_plan.open(file);
  } else if (isTrack(file)) {
    m_tracks.add(readTrack(file));
    listTracks();
    text +=
        strict_files::textOf(std::round(m_tracks.track(m_tracks.size() - 1).length() * 10) / 10) +
        " m";
  } else {
    m_viewer.add(std::make_unique<Layer>(file, m_wantedTiles));
    const Layer& layer = m_viewer.layer(m_viewer.numLayers() - 1);
    text += std::to_string(layer.map().getNumLeafNodes()) + " leaves";
  }
  m_viewer.say(text);
}

/** The last one first. */
void FilesPanel::listTracks() {
  removeChildren(m_list);
  for (std::size_t i = m_tracks.size(); i-- > 0;) {
    const auto show = [this, i](bool on) {
      m_tracks.setShown(i, on);
      m_viewer.say((on ? "shows " : "hides ") + m_tracks.track(i).name);
    };
    addCheckBox(m_list, m_tracks.track(i).name, kFilesWidth - 20, m_tracks.isShown(i), show);
  }
  m_panel->setVisible(m_tracks.size() > 0);
}

}  // namespace semantic_map_view
