#include "TileScene.h"

#include <set>

#include "measuring/Stopwatch.h"

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

}  // namespace map_window
