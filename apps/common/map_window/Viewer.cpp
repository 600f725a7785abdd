#include "Viewer.h"

#include <GLFW/glfw3.h>
#include <map_pictures/MapPictures.h>
#include <strict_files/Words.h>

#include <iostream>

#include "StandardOutput.h"

namespace map_window {

namespace fs = std::filesystem;

namespace {

/** Cells are at least so large, pixels: at once after a change, while the camera moves, and when it
 * rests for a while (s). */
constexpr double kHurrying = 12, kMoving = 6, kResting = 4, kRest = 0.2;
/** For meshes in each frame, so that the window answers meanwhile: at once after a change, and
 * else.
 */
constexpr double kHurry = 12, kMilliseconds = 50;

}  // namespace

Viewer::Viewer(ViewWindow& window, std::vector<std::unique_ptr<Layer>> layers,
               const Beginning& beginning)
    : m_window(window) {
  for (auto& layer : layers) {
    layer->look().setStyle(beginning.style);
    m_maps.push_back({std::move(layer), {}, true});
  }
  insertMaps();
  if (beginning.camera)
    m_window.setOrbitCamera(*beginning.camera);
  else if (beginning.top)
    lookFrom(-90, 90);
  else
    lookFrom(-120, 35);
  m_window.onFrame([this] { return frame(); });
}

void Viewer::add(std::unique_ptr<Layer> layer) {
  map_view::ViewStyle own = style();
  own.hiddenClasses.clear();  // it may have other classes
  layer->look().setStyle(own);
  m_maps.push_back({std::move(layer), {}, true});
  insertMaps();
  for (const auto& f : m_onAdded) f();
}

bool Viewer::frame() {
  for (const auto& f : m_onFrame) f();
  map_view::View view = {m_window.orbitCamera(), m_window.pixelWidth(), m_window.pixelHeight(),
                         kResting};
  const std::string camera = view.camera.text();
  if (camera != m_camera && !m_camera.empty()) m_restAt = glfwGetTime() + kRest;
  m_camera = camera;
  const bool moves = glfwGetTime() < m_restAt;
  if (moves) view.pixelsPerCell = kMoving;
  if (m_hurries) view.pixelsPerCell = kHurrying;
  const double time = (m_hurries ? kHurry : kMilliseconds) / double(m_maps.size());
  bool ready = !moves && !m_hurries;
  for (OpenMap& map : m_maps)
    if (map.isShown && !map.tiles.update(*map.layer, view, time)) ready = false;
  m_hurries = false;
  return !ready;
}

void Viewer::changed(const std::vector<map_view::KeyBox>& boxes) {
  tiles().touch(boxes);
  m_window.redraw();
  m_hurries = !boxes.empty();
}

void Viewer::insertMaps() {
  m_window.maps()->clear();
  for (const OpenMap& map : m_maps)
    if (map.isShown) m_window.maps()->insert(map.tiles.objects());
  m_window.redraw();
}

void Viewer::setShown(std::size_t layer, bool isShown) {
  m_maps[layer].isShown = isShown;
  insertMaps();
}

void Viewer::activate(std::size_t layer) {
  showFull();
  m_active = layer;
  setShown(layer, true);
  for (const auto& f : m_onActivated) f();
}

void Viewer::setStyle(const map_view::ViewStyle& style) {
  for (OpenMap& map : m_maps) {
    map_view::ViewStyle own = style;
    if (map.layer.get() != &layer()) own.hiddenClasses = map.layer->look().style().hiddenClasses;
    map.layer->look().setStyle(own);
    map.tiles.touch();
  }
  m_window.redraw();
}

Eigen::AlignedBox3d Viewer::extent() const {
  Eigen::AlignedBox3d all;
  for (const OpenMap& map : m_maps)
    if (map.isShown) all.extend(map.layer->extent());
  return all.isEmpty() ? m_maps[m_active].layer->extent() : all;
}

void Viewer::lookFrom(double azimuth, double elevation) {
  map_view::OrbitCamera camera;
  camera.azimuth = azimuth, camera.elevation = elevation;
  m_window.setOrbitCamera(camera.seeing(extent(), m_window.pixelWidth(), m_window.pixelHeight()));
}

fs::path Viewer::newFile(const fs::path& folder, const std::string& stem,
                         const std::string& ending) {
  fs::path file;
  int number = 1;
  do file = folder / (stem + "-" + std::to_string(number++) + ending);
  while (fs::exists(file));
  return file;
}

fs::path Viewer::savePicture(const fs::path& folder) {
  const fs::path file = newFile(folder, "map-view", ".png");
  while (m_window.drawFrame()) {
  }
  map_pictures::savePicture(m_window.drawPicture(), file);
  return file;
}

void Viewer::showFull() {
  layer().setCells(std::make_unique<map_view::FullCells>(layer().map()));
  layer().look().setCompression(nullptr);
  tiles().touch();
  m_window.redraw();
}

void Viewer::showCompressed(const map_view::LiveCompression& compression) {
  layer().setCells(std::make_unique<map_view::CompressedCells>(layer().map(), compression));
  layer().look().setCompression(&compression);
  tiles().touch();
  m_window.redraw();
}

void Viewer::say(const std::string& text) {
  m_said = text;
  notes() << text << std::endl;
  m_window.redraw();
}

void Viewer::complain(const std::exception& problem) {
  m_said = strict_files::messageOf(problem);
  std::cerr << m_window.caption() << ": " << m_said << std::endl;
  m_window.redraw();
}

}  // namespace map_window
