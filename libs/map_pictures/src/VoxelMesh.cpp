#include "VoxelMesh.h"

#include <semantic_types/ClassTable.h>

#include <array>
#include <vector>

namespace map_pictures {

using mrpt_compat::drawing::CSetOfTriangles;
using mrpt_compat::drawing::TTriangle;
using semantic_octree::SemanticOcTree;

namespace {

struct Face {
  Eigen::Vector3i normal, u, v;  ///< u x v = normal
  float brightness;
};

const std::array<Face, 6> kFaces = {{{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 1.0f},
                                     {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}, 0.5f},
                                     {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 0.8f},
                                     {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}, 0.8f},
                                     {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}, 0.66f},
                                     {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}, 0.66f}}};

/** Which of the 26 places around a cell, of its size, are filled. */
class Neighborhood {
 public:
  Neighborhood(const SemanticOcTree& tree, const MapCells& map, const MapCell& cell)
      : m_tree(tree), m_map(map), m_cell(cell) {}

  bool isFilled(const Eigen::Vector3i& step) {
    State& state = m_states[(step.x() + 1) * 9 + (step.y() + 1) * 3 + step.z() + 1];
    if (state == State::NotAsked) state = lookUp(step) ? State::Filled : State::Empty;
    return state == State::Filled;
  }

 private:
  enum class State : std::uint8_t { NotAsked, Empty, Filled };

  bool lookUp(const Eigen::Vector3i& step) const {
    if (m_map.isCutOff(m_cell.center + step.cast<float>() * m_cell.size)) return false;
    octomap::OcTreeKey key;
    const int keys = 1 << (m_tree.getTreeDepth() - m_cell.depth);
    for (int axis = 0; axis < 3; ++axis) {
      const int k = m_cell.key[axis] + step[axis] * keys;
      if (k < 0 || k > 0xffff) return false;
      key[axis] = static_cast<octomap::key_type>(k);
    }
    const auto node = m_tree.search(key, m_cell.depth);
    return node && node->getOccupancy() > MapCells::kOccupied &&
           (node->isLeaf() || m_cell.depth == m_map.depth);
  }

  const SemanticOcTree& m_tree;
  const MapCells& m_map;
  const MapCell& m_cell;
  std::array<State, 27> m_states{};
};

/** 0 (dark) to 3: how open the corner (su, sv) of a face is. */
int openness(Neighborhood& around, const Face& face, int su, int sv) {
  const bool a = around.isFilled(face.normal + su * face.u);
  const bool b = around.isFilled(face.normal + sv * face.v);
  if (a && b) return 0;
  return 3 - int(a) - int(b) - int(around.isFilled(face.normal + su * face.u + sv * face.v));
}

class MeshBuilder {
 public:
  explicit MeshBuilder(const semantic_types::ClassTable& classes) : m_classes(classes) {}

  void addFace(const MapCell& cell, const Face& face, Neighborhood& around) {
    // Corners in the order that turns to the left seen from outside.
    constexpr std::array<std::array<int, 2>, 4> kCorners = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    std::array<TTriangle::Vertex, 4> corners;
    std::array<int, 4> open;
    for (int i = 0; i < 4; ++i) {
      const auto [su, sv] = kCorners[i];
      open[i] = openness(around, face, su, sv);
      const Eigen::Vector3f p =
          cell.center + cell.size / 2 * (face.normal + su * face.u + sv * face.v).cast<float>();
      corners[i] = vertex(p, face, cell.id, face.brightness * (0.55f + 0.15f * float(open[i])));
    }
    // The diagonal that keeps the shade of a corner from crossing the face.
    const int first = open[0] + open[2] >= open[1] + open[3] ? 0 : 1;
    for (const int second : {first + 1, first + 2}) {
      TTriangle triangle;
      triangle.vertices = {corners[first], corners[second], corners[(second + 1) % 4]};
      m_triangles.push_back(triangle);
    }
  }

  CSetOfTriangles::Ptr take() const {
    const auto mesh = CSetOfTriangles::Create();
    mesh->insertTriangles(m_triangles);
    mesh->enableLight(false);  // the colors are lit already
    mesh->cullFaces(mrpt_compat::drawing::TCullFace::NONE);
    return mesh;
  }

 private:
  TTriangle::Vertex vertex(const Eigen::Vector3f& p, const Face& face, semantic_types::ClassId id,
                           float brightness) const {
    TTriangle::Vertex v;
    v.xyzrgba.pt = {p.x(), p.y(), p.z()};
    v.normal = {float(face.normal.x()), float(face.normal.y()), float(face.normal.z())};
    const auto c = colorOf(id, m_classes);
    const auto shade = [brightness](std::uint8_t x) {
      return static_cast<std::uint8_t>(float(x) * brightness + 0.5f);
    };
    v.setColor({shade(c.r), shade(c.g), shade(c.b), 255});
    return v;
  }

  const semantic_types::ClassTable& m_classes;
  std::vector<TTriangle> m_triangles;
};

}  // namespace

CSetOfTriangles::Ptr meshOf(const SemanticOcTree& tree, const MapCells& map) {
  MeshBuilder mesh(tree.classes());
  for (const MapCell& cell : map.cells) {
    Neighborhood around(tree, map, cell);
    for (const Face& face : kFaces)
      if (!around.isFilled(face.normal)) mesh.addFace(cell, face, around);
  }
  return mesh.take();
}

}  // namespace map_pictures
