#include <map_view/TileSet.h>

#include <cstdint>

namespace map_view {

namespace {

struct Side {
  Eigen::Array3i normal, u, v;  ///< u x v = normal
  float brightness;
};

const std::array<Side, kNumDirections> kSides = {{{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 1.0f},
                                                  {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}, 0.5f},
                                                  {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 0.8f},
                                                  {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}, 0.8f},
                                                  {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}, 0.66f},
                                                  {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}, 0.66f}}};

enum class Content : std::uint8_t { Nothing, Free, Unknown, Occupied };

Content contentOf(const ViewCell& cell) {
  if (!cell.node) return Content::Unknown;
  return cell.isOccupied() ? Content::Occupied : Content::Free;
}

/** What is where in a tile and one cell around it. */
class Grid {
 public:
  Content& at(const Eigen::Array3i& place) {
    return m_content[std::size_t(((place.z() + 1) * kEdge + place.y() + 1) * kEdge + place.x() +
                                 1)];
  }
  Content at(const Eigen::Array3i& place) const { return const_cast<Grid*>(this)->at(place); }
  bool isOccupied(const Eigen::Array3i& place) const { return at(place) == Content::Occupied; }

  template <class F>
  static void forEach(const Eigen::Array3i& low, const Eigen::Array3i& end, const F& f) {
    for (int z = low.z(); z < end.z(); ++z)
      for (int y = low.y(); y < end.y(); ++y)
        for (int x = low.x(); x < end.x(); ++x) f(Eigen::Array3i(x, y, z));
  }

 private:
  static constexpr int kEdge = kCellsPerTile + 2;
  std::vector<Content> m_content =
      std::vector<Content>(std::size_t(kEdge) * kEdge * kEdge, Content::Nothing);
};

/** A cell's part of a tile, in cells of the tile from its lowest one; `end` is outside. */
struct Part {
  Eigen::Array3i low, end;
  ViewCell cell;
};

class MeshBuilder {
 public:
  MeshBuilder(const Tile& tile, const CellLook& look, double voxelSize)
      : m_tile(tile), m_look(look), m_voxelSize(voxelSize) {}

  KeyBox box() const {
    const int border = m_tile.cellEdge();
    return {m_tile.lowest - border, m_tile.lowest + (m_tile.edge() + border - 1)};
  }

  void add(const ViewCell& cell) {
    const int unit = m_tile.cellEdge();
    // Exact: cells outside of the tile begin at multiples of a cell, too.
    const Eigen::Array3i low = (cell.lowest - m_tile.lowest) / unit, end = low + cell.edge() / unit;
    const Content content = contentOf(cell);
    Grid::forEach(low.max(-1), end.min(kCellsPerTile + 1),
                  [&](const Eigen::Array3i& place) { m_grid.at(place) = content; });
    const Part part = {low.max(0), end.min(kCellsPerTile), cell};
    if ((part.low < part.end).all()) m_parts.push_back(part);
  }

  TileMesh build() {
    TileMesh mesh;
    for (const Part& part : m_parts) addFaces(part, mesh);
    return mesh;
  }

 private:
  void addFaces(const Part& part, TileMesh& mesh) const {
    std::optional<Color> color;
    for (std::size_t i = 0; i < kNumDirections; ++i) {
      if (isHidden(part, kSides[i])) continue;
      if (!color) color = colorOf(part.cell);
      auto& faces = part.cell.isOccupied() ? mesh.occupied[i] : mesh.translucent;
      faces.push_back(face(part, kSides[i], *color));
    }
  }

  /** By its own kind, or by what is solid. */
  bool isHidden(const Part& part, const Side& side) const {
    const Eigen::Array3i one = side.normal.abs();
    Eigen::Array3i low = part.low, end = part.end;
    if (side.normal.sum() > 0)
      low = low * (1 - one) + end * one, end = end + one;
    else
      end = end * (1 - one) + low * one, low = low - one;
    const Content own = contentOf(part.cell);
    for (int z = low.z(); z < end.z(); ++z)
      for (int y = low.y(); y < end.y(); ++y)
        for (int x = low.x(); x < end.x(); ++x)
          if (const Content c = m_grid.at({x, y, z}); c != own && c != Content::Occupied)
            return false;
    return true;
  }

  /** A little brighter or darker from cell to cell, so that their sizes show. */
  Color colorOf(const ViewCell& cell) const {
    const Color c = m_look.colorOf(cell);
    std::uint32_t hash = std::uint32_t(cell.lowest.x() / cell.edge()) * 73856093u ^
                         std::uint32_t(cell.lowest.y() / cell.edge()) * 19349663u ^
                         std::uint32_t(cell.lowest.z() / cell.edge()) * 83492791u;
    hash = (hash ^ hash >> 13) * 0x5bd1e995u;
    return shaded(c, 0.96f + 0.04f * float(hash >> 24) / 255);
  }

  static Color shaded(const Color& c, float brightness) {
    const auto byte = [&](std::uint8_t x) { return std::uint8_t(float(x) * brightness + 0.5f); };
    return {byte(c.r), byte(c.g), byte(c.b)};
  }

  Face face(const Part& part, const Side& side, const Color& color) const {
    // Corners in the order that turns to the left seen from outside.
    constexpr std::array<std::array<int, 2>, 4> kCorners = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    Face face;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto [su, sv] = kCorners[i];
      face.corners[i] = place(part, side.normal + su * side.u + sv * side.v);
      const int open = part.cell.isOccupied() ? openness(part, side, su, sv) : 3;
      face.colors[i] = shaded(color, side.brightness * (0.55f + 0.15f * float(open)));
    }
    return face;
  }

  /** Where a corner is, m: -1 is the low end of an axis, 1 the high one. */
  Eigen::Vector3f place(const Part& part, const Eigen::Array3i& corner) const {
    const Eigen::Array3i at = (corner < 0).select(part.low, part.end);
    const Eigen::Array3i key = m_tile.lowest + at * m_tile.cellEdge();
    return ((key - semantic_octree::kKeyOfOrigin).cast<double>() * m_voxelSize)
        .cast<float>()
        .matrix();
  }

  /** 0 (dark) to 3: how open the corner (su, sv) of a side is. */
  int openness(const Part& part, const Side& side, int su, int sv) const {
    const Eigen::Array3i corner = side.normal + su * side.u + sv * side.v;
    const Eigen::Array3i inside = (corner < 0).select(part.low, part.end - 1);
    const Eigen::Array3i out = inside + side.normal;
    const bool a = m_grid.isOccupied(out + su * side.u), b = m_grid.isOccupied(out + sv * side.v);
    if (a && b) return 0;
    return 3 - int(a) - int(b) - int(m_grid.isOccupied(out + su * side.u + sv * side.v));
  }

  const Tile& m_tile;
  const CellLook& m_look;
  double m_voxelSize;
  Grid m_grid;
  std::vector<Part> m_parts;
};

}  // namespace

Eigen::Vector3i normalOf(std::size_t direction) { return kSides.at(direction).normal.matrix(); }

bool mayFace(const Tile& tile, std::size_t direction, const Eigen::Vector3d& place,
             double voxelSize) {
  const Eigen::Array3i normal = kSides.at(direction).normal;
  const int axis = normal.x() != 0 ? 0 : normal.y() != 0 ? 1 : 2;
  const double key = place[axis] / voxelSize + semantic_octree::kKeyOfOrigin;
  return normal[axis] > 0 ? key > tile.lowest[axis] : key < tile.lowest[axis] + tile.edge();
}

TileMesh meshOf(const Tile& tile, const CellSource& cells, const CellLook& look) {
  MeshBuilder builder(tile, look, cells.map().getResolution());
  cells.forEachShown(builder.box(), tile.cellDepth(), look,
                     [&](const ViewCell& cell) { builder.add(cell); });
  return builder.build();
}

}  // namespace map_view
