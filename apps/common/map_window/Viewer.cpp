#include "Viewer.h"

#include <GLFW/glfw3.h>
#include <map_pictures/MapPictures.h>
#include <strict_files/Words.h>

#include <iostream>
#include <set>

#include "Terminal.h"
#include "measuring/Measuring.h"

namespace map_window {

using map_view::Face;
using map_view::Tile;
using mrpt_compat::drawing::CSetOfObjects;
using mrpt_compat::drawing::CSetOfTriangles;
using mrpt_compat::drawing::TTriangle;

namespace {

/** Sides of cells whose meshes are kept: about 216 bytes each. */
constexpr std::size_t kMostFaces = 2'000'000;
constexpr std::uint8_t kTranslucent = 40;  // of 255

CSetOfTriangles::Ptr trianglesOf(const std::vector<Face>& faces, std::uint8_t alpha) {
  std::vector<TTriangle> triangles;
  triangles.reserve(2 * faces.size());
  for (const Face& face : faces) {
    const auto vertex = [&](std::size_t i) {
      TTriangle::Vertex v;
      v.xyzrgba.pt = {face.corners[i].x(), face.corners[i].y(), face.corners[i].z()};
      v.setColor({face.colors[i].r, face.colors[i].g, face.colors[i].b, alpha});
      return v;
    };
    // The diagonal that keeps the shade of a corner from crossing the face.
    const auto bright = [&](std::size_t i) {
      return int(face.colors[i].r) + face.colors[i].g + face.colors[i].b;
    };
    const std::size_t first = bright(0) + bright(2) >= bright(1) + bright(3) ? 0 : 1;
    for (const std::size_t second : {first + 1, first + 2}) {
      TTriangle triangle;
      triangle.vertices = {vertex(first), vertex(second), vertex((second + 1) % 4)};
      triangles.push_back(triangle);
    }
  }
  const auto mesh = CSetOfTriangles::Create();
  mesh->insertTriangles(triangles);
  mesh->enableLight(false);  // the colors are lit already
  mesh->cullFaces(mrpt_compat::drawing::TCullFace::BACK);
  return mesh;
}

}  // namespace

std::size_t TileScene::Meshes::faces() const {
  std::size_t sum = translucent.faces;
  for (const Part& part : occupied) sum += part.faces;
  return sum;
}

void TileScene::build(const Layer& layer, const Tile& tile) {
  const map_view::TileMesh mesh = meshOf(tile, layer.cells(), layer.look());
  const auto part = [](const std::vector<Face>& faces, std::uint8_t alpha) {
    return faces.empty() ? Meshes::Part() : Meshes::Part{trianglesOf(faces, alpha), faces.size()};
  };
  Meshes& meshes = m_meshes[tile];
  m_kept -= meshes.faces();
  for (std::size_t i = 0; i < mesh.occupied.size(); ++i)
    meshes.occupied[i] = part(mesh.occupied[i], 255);
  meshes.translucent = part(mesh.translucent, kTranslucent);
  m_kept += meshes.faces();
  m_fresh.add(tile);
}

bool TileScene::update(const Layer& layer, const map_view::View& view, double milliseconds) {
  const measuring::Stopwatch watch;
  const std::vector<Tile> tiles = tilesSeen(layer.map(), view, layer.look());
  bool ready = true;
  for (const Tile& tile : tiles) {
    if (m_fresh.contains(tile)) continue;
    if (watch.milliseconds() > milliseconds) {
      ready = false;
      break;
    }
    build(layer, tile);
  }
  show(tiles, view.camera, layer.map().getResolution());
  if (m_kept > kMostFaces) forgetUnseen(tiles);
  return ready;
}

Tile TileScene::standIn(const Tile& tile) const {
  const auto isFresh = [this](const Tile& t) { return m_fresh.contains(t); };
  const auto isThere = [this](const Tile& t) { return m_meshes.count(t) > 0; };
  const auto around = [&](const auto& is) {
    Tile t = tile;
    while (t.depth > 0 && !is(t)) t = t.around();
    return t;
  };
  const Tile fresh = around(isFresh);
  return isFresh(fresh) ? fresh : around(isThere);
}

void TileScene::show(const std::vector<Tile>& tiles, const map_view::OrbitCamera& camera,
                     double voxelSize) {
  std::set<Tile> shown;  // coarse ones first
  for (const Tile& tile : tiles) {
    const Tile found = standIn(tile);
    if (m_meshes.count(found) > 0) shown.insert(found);
  }
  const auto isInAnother = [&shown](Tile tile) {
    while (tile.depth > 0)
      if (tile = tile.around(); shown.count(tile) > 0) return true;
    return false;
  };
  for (auto tile = shown.begin(); tile != shown.end();)
    tile = isInAnother(*tile) ? shown.erase(tile) : std::next(tile);
  m_objects->clear();
  const auto translucent = CSetOfObjects::Create();
  const auto add = [](const auto& objects, const Meshes::Part& part) {
    if (part.triangles) objects->insert(part.triangles);
  };
  const Eigen::Vector3d eye = camera.position(),
                        near = eye + camera.distance / 50 * camera.forward();
  for (const Tile& tile : shown) {
    const Meshes& meshes = m_meshes.at(tile);
    for (std::size_t i = 0; i < meshes.occupied.size(); ++i)
      if (mayFace(tile, i, eye, voxelSize)) add(m_objects, meshes.occupied[i]);
    // MRPT draws what it takes to be nearest last: the solid cells are to be seen through these.
    if (meshes.translucent.triangles)
      meshes.translucent.triangles->setLocalRepresentativePoint(
          {float(near.x()), float(near.y()), float(near.z())});
    add(translucent, meshes.translucent);
  }
  m_objects->insert(translucent);
}

void TileScene::forgetUnseen(const std::vector<Tile>& seen) {
  const std::set<Tile> keep(seen.begin(), seen.end());
  for (auto it = m_meshes.begin(); it != m_meshes.end();) {
    if (keep.count(it->first) > 0) {
      ++it;
      continue;
    }
    m_kept -= it->second.faces();
    m_fresh.remove(it->first);
    it = m_meshes.erase(it);
  }
}

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
  showCompressed(nullptr);
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

void Viewer::showCompressed(const map_view::LiveCompression* compression) {
  layer().showCompressed(compression);
  tiles().touch();
  m_window.redraw();
}

void Viewer::say(const std::string& text) {
  m_said = text;
  notes() << text << std::endl;
  m_window.redraw();
}

void Viewer::attempt(const std::function<void()>& action) try {
  action();
} catch (const std::exception& e) {
  m_said = strict_files::messageOf(e);
  std::cerr << m_window.caption() << ": " << m_said << std::endl;
  m_window.redraw();
}

}  // namespace map_window
