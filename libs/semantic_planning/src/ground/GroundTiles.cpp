#include "GroundTiles.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "ColumnGrid.h"
#include "SurfaceTile.h"

namespace semantic_planning {
namespace {

/** Rise along an axis, voxels per voxel, between the surfaces at both ends of the baseline; less
 * the one voxel that rounding of heights can make. */
double riseAlong(const SurfaceWindow& surfaces, Column c, const Surface& s, Column half,
                 const GroundShape& shape) {
  const int tolerance = shape.step * shape.baseline;
  const Surface* before = surfaceNear(surfaces, {c.x - half.x, c.y - half.y}, s.z, tolerance);
  const Surface* after = surfaceNear(surfaces, {c.x + half.x, c.y + half.y}, s.z, tolerance);
  const int columns = shape.baseline * ((before ? 1 : 0) + (after ? 1 : 0));
  if (columns == 0) return 0;
  const int rise = int(after ? after->z : s.z) - int(before ? before->z : s.z);
  return std::max(0, std::abs(rise) - 1) / double(columns);
}

/** Marks the surfaces of a tile that are not too steep as drivable.
 * \param marked the tile, in `surfaces` \return the columns whose marks changed. */
ColumnBox markDrivable(const SurfaceGrid& surfaces, Column tile, SurfaceTile& marked,
                       const GroundShape& shape) {
  ColumnBox changed;
  if (marked.surfaces.empty()) return changed;
  const SurfaceWindow window(surfaces, tile, shape.baseline);
  forSurfacesOf(tile, marked, [&](Column c, std::size_t i) {
    Surface& s = marked.surfaces[i];
    const double x = riseAlong(window, c, s, {shape.baseline, 0}, shape);
    const double y = riseAlong(window, c, s, {0, shape.baseline}, shape);
    const bool drivable = (x == 0 ? y : y == 0 ? x : std::hypot(x, y)) <= shape.rise;
    if (s.drivable != drivable) changed.add(c);
    s.drivable = drivable;
  });
  return changed;
}

/** What a stage changed in some tiles. */
template <class Stage>
std::vector<ColumnBox> changedBy(const std::vector<Column>& tiles, Stage stage) {
  std::vector<ColumnBox> changed;
  for (const Column& tile : tiles)
    if (const ColumnBox box = stage(tile); !box.empty()) changed.push_back(box);
  return changed;
}

/** What a stage changed in the surfaces of some tiles: stage(tile, its surfaces). */
template <class Stage>
std::vector<ColumnBox> changedBy(SurfaceGrid& surfaces, const std::vector<Column>& tiles,
                                 Stage stage) {
  return changedBy(tiles, [&](Column tile) {
    SurfaceTile* found = surfaces.find(tile);
    return found ? stage(tile, *found) : ColumnBox();
  });
}

/** The tile of a grid, which is set only if there is anything to be in it. */
template <class T>
ColumnBox replace(ColumnGrid<T>& grid, Column tile, T value) {
  static const T none{};
  const T* before = grid.find(tile);
  ColumnBox changed;
  forColumnsOf(tile, [&](Column c) {
    if (!value.sameColumn(indexInTile(c), before ? *before : none)) changed.add(c);
  });
  if (!changed.empty()) grid.at(tile) = std::move(value);
  return changed;
}

void append(std::vector<ColumnBox>& boxes, const std::vector<ColumnBox>& more) {
  boxes.insert(boxes.end(), more.begin(), more.end());
}

std::vector<Column> tilesOf(const std::vector<ColumnBox>& boxes) { return tilesWithin(boxes, 0); }

std::vector<ColumnBox> boxesOf(const std::vector<Column>& tiles) {
  std::vector<ColumnBox> boxes;
  for (const Column& tile : tiles) boxes.push_back({firstColumnOf(tile), lastColumnOf(tile)});
  return boxes;
}

/** The surfaces of a tile, and in columns without any those that are assumed, but over drops. */
SurfaceTile withAssumed(const SurfaceTile& measured, const SurfaceTile& assumed,
                        const ColumnTile& columns, const GroundShape& shape) {
  SurfaceTile all;
  for (int column = 0; column < kTileColumns; ++column) {
    const bool isMeasured = !measured.column(column).empty();
    for (const Surface& s : (isMeasured ? measured : assumed).column(column))
      if (isMeasured || !columns.isOverDrop(column, s.z, s.z, shape.step, shape.height))
        all.surfaces.push_back(s);
    all.first[column + 1] = static_cast<std::uint16_t>(all.surfaces.size());
  }
  return all;
}

/** Whether a column has something occupied between two heights below a node, which begins at z. */
bool isAnyOccupied(const semantic_octree::SemanticOcTree::Node& node, int size, int z, Column c,
                   int low, int high) {
  if (z > high || z + size <= low) return false;
  if (node.getLogOdds() <= 0) return false;  // an inner node's is its most occupied leaf's
  if (node.isLeaf()) return true;
  const int half = size / 2, inColumn = (c.x & half ? 1 : 0) + (c.y & half ? 2 : 0);
  for (const int upper : {0, 1})
    if (const auto child = node.child(inColumn + 4 * upper))
      if (isAnyOccupied(child, half, z + upper * half, c, low, high)) return true;
  return false;
}

/** Lets surfaces that stay keep what later stages found out about them. */
void keepMarks(const SurfaceTile& before, SurfaceTile& tile) {
  for (int column = 0; column < kTileColumns; ++column) {
    const SurfaceRange kept = before.column(column);
    if (tile.sameColumn(column, before))
      std::copy(kept.begin(), kept.end(), tile.surfaces.begin() + tile.first[column]);
  }
}

}  // namespace

void GroundTiles::read(const std::vector<Column>& tiles) {
  constexpr std::size_t kManyTiles = 4 * kSquareEdge * kSquareEdge;
  if (tiles.size() < kManyTiles)
    finished(updateSurfaces(tiles));
  else
    readSquares(tiles);
  forgetStages();
}

std::vector<Column> GroundTiles::update(const std::vector<Column>& tiles) {
  if (tiles.empty()) return {};
  std::vector<Column> unknownBefore;
  std::copy_if(tiles.begin(), tiles.end(), std::back_inserter(unknownBefore),
               [this](const Column& tile) { return !m_columns.find(tile); });
  recallStages(tiles);
  std::vector<Column> changed = finished(updateSurfaces(
      tiles, tilesWithin(boxesOf(unknownBefore), kReachOfClasses + 2 * reachOfGapFills(m_shape))));
  if (m_numRead > 4 * m_mostNeeded) forgetStages();
  return changed;
}

std::vector<Column> GroundTiles::assume(SurfaceGrid ground) {
  std::vector<Column> tiles;
  for (const SurfaceGrid* grid : {&m_assumed, &ground})
    grid->forEach([&](Column tile, const SurfaceTile&) { tiles.push_back(tile); });
  if (tiles.empty()) return {};
  recallStages(tiles);
  m_assumed = std::move(ground);
  return finished(updateSurfaces(boxesOf(tiles), {}));
}

std::vector<Column> GroundTiles::finished(std::vector<ColumnBox> changed) {
  append(changed, updateClearance(changed));
  if (!changed.empty()) m_components.reset();
  return tilesOf(changed);
}

std::unique_ptr<GroundTiles> GroundTiles::frozen() const {
  auto tiles = std::make_unique<GroundTiles>(m_map, m_shape);
  tiles->m_surfaces = m_surfaces;
  return tiles;
}

std::vector<Column> GroundTiles::known() const {
  std::vector<Column> tiles;
  m_columns.forEach([&](Column tile, const ColumnTile&) { tiles.push_back(tile); });
  m_surfaces.forEach([&](Column tile, const SurfaceTile&) { tiles.push_back(tile); });
  return tiles;
}

bool GroundTiles::isOccupied(Column c, int low, int high) const {
  if (const ColumnTile* tile = m_columns.find(tileOf(c))) {
    const semantic_octree::ByColumn<Run>& runs = tile->runs;
    return std::any_of(runs.begin(indexInTile(c)), runs.end(indexInTile(c)),
                       [&](const Run& run) { return run.top >= low && run.bottom <= high; });
  }
  if (std::min(c.x, c.y) < 0 || std::max(c.x, c.y) >= semantic_octree::kNumKeys) return false;
  const auto root = m_map.root();
  return root && isAnyOccupied(root, semantic_octree::kNumKeys, 0, c, low, high);
}

void GroundTiles::forgetStages() {
  m_columns = {};
  m_measured = {};
  m_fills = {};
  m_obstacles = {};
  m_numRead = 0;
}

void GroundTiles::recallStages(const std::vector<Column>& tiles) {
  std::map<Column, ColumnBox> squares;
  for (const ColumnBox& box : boxesOf(tiles)) squares[squareOf(box.tile())].add(box);
  std::vector<ColumnBox> boxes;
  for (const auto& [square, box] : squares) boxes.push_back(box);
  const int reach = reachOfGapFills(m_shape);
  const auto forTiles = [&boxes](int margin, const auto& f) {
    forTilesWithin(boxes, {margin, margin, margin, margin}, f);
  };
  // Fills come and go as far as surfaces are measured. What they cross is filled again: fills from
  // farther count, and end still farther.
  const int fills = kReachOfClasses + 3 * reach, surfaces = fills + reach;
  const auto make = [](auto& grid, Column tile, const auto& stage) {
    if (grid.find(tile)) return false;
    grid.at(tile) = stage(tile);
    return true;
  };
  std::size_t needed = 0;
  forTiles(surfaces + kReachOfClasses, [&](Column t) {
    ++needed;
    m_numRead += make(m_columns, t, [this](Column tile) { return m_scanner.scan(tile); });
  });
  m_mostNeeded = std::max(m_mostNeeded, needed);
  forTiles(surfaces,
           [&](Column t) { make(m_measured, t, [this](Column tile) { return measured(tile); }); });
  forTiles(fills, [&](Column t) {
    make(m_fills, t,
         [this](Column tile) { return gapFillsFrom(m_columns, m_measured, tile, m_shape); });
  });
  // Beside what becomes an obstacle the clearance of whole tiles is measured anew.
  const int slopes = fills + m_shape.baseline;
  forTiles(slopes + 1 + 2 * m_shape.largestClearance + kTileEdge, [&](Column t) {
    make(m_obstacles, t, [this](Column tile) { return obstaclesIn(m_surfaces, tile, m_shape); });
  });
}

void GroundTiles::readSquares(const std::vector<Column>& tiles) {
  std::map<Column, std::vector<Column>> squares;
  for (const Column& tile : tiles) squares[squareOf(tile)].push_back(tile);
  for (const auto& [square, within] : squares) {
    GroundTiles part(m_map, m_shape);
    part.finished(part.updateSurfaces(tilesWithin(boxesOf(within), reachOfGround(m_shape))));
    for (const Column& tile : within)
      if (SurfaceTile* surfaces = part.m_surfaces.find(tile))
        m_surfaces.at(tile) = std::move(*surfaces);
  }
}

std::vector<ColumnBox> GroundTiles::updateSurfaces(const std::vector<Column>& tiles,
                                                   std::vector<Column> refilled) {
  return updateSurfaces(
      changedBy(inMortonOrder(tiles),
                [&](Column t) { return replace(m_columns, t, m_scanner.scan(t)); }),
      std::move(refilled));
}

std::vector<ColumnBox> GroundTiles::updateSurfaces(std::vector<ColumnBox> scanned,
                                                   std::vector<Column> refilled) {
  append(scanned, changedBy(tilesWithin(scanned, kReachOfClasses),
                            [&](Column t) { return replace(m_measured, t, measured(t)); }));
  const int reach = reachOfGapFills(m_shape);
  for (const Column& t : tilesWithin(scanned, {reach, reach, reach, 0})) findFills(t);
  for (const Column& t : tilesWithin(scanned, {2 * reach, 2 * reach, reach, reach}))
    refilled.push_back(t);  // what those fills may cross
  sortOut(refilled);
  auto changed = changedBy(refilled, [&](Column t) { return fill(t); });
  const auto sloped = tilesWithin(changed, m_shape.baseline);
  append(changed, changedBy(m_surfaces, sloped, [&](Column tile, SurfaceTile& surfaces) {
           return markDrivable(m_surfaces, tile, surfaces, m_shape);
         }));
  return changed;
}

std::vector<ColumnBox> GroundTiles::updateClearance(const std::vector<ColumnBox>& changed) {
  const auto obstacles =
      changedBy(tilesWithin(changed, 1), [&](Column t) { return findObstacles(t); });
  const std::vector<Column> tiles = tilesOf(changed);
  std::vector<Column> measured = tilesWithin(obstacles, m_shape.largestClearance);
  measured.insert(measured.end(), tiles.begin(), tiles.end());
  sortOut(measured);
  auto finished = changedBy(m_surfaces, measured, [&](Column tile, SurfaceTile& surfaces) {
    return m_clearanceMeter.measure(m_obstacles, tile, surfaces);
  });
  append(finished, changedBy(m_surfaces, tiles, [&](Column tile, SurfaceTile& surfaces) {
           return markComponents(tile, surfaces, m_shape);
         }));
  return finished;
}

SurfaceTile GroundTiles::measured(Column tile) const {
  SurfaceTile measured = measuredSurfaces(m_columns, tile, m_shape);
  const SurfaceTile* assumed = m_assumed.find(tile);
  if (!assumed) return measured;
  const ColumnTile* columns = m_columns.find(tile);
  return withAssumed(measured, *assumed, columns ? *columns : ColumnTile(), m_shape);
}

void GroundTiles::findFills(Column tile) {
  GapFillTile found = gapFillsFrom(m_columns, m_measured, tile, m_shape);
  if (!found.fills.empty() || m_fills.find(tile)) m_fills.at(tile) = std::move(found);
}

ColumnBox GroundTiles::fill(Column tile) {
  SurfaceTile filled = filledSurfaces(m_fills, m_measured, m_columns, tile, m_shape);
  if (const SurfaceTile* before = m_surfaces.find(tile)) keepMarks(*before, filled);
  return replace(m_surfaces, tile, std::move(filled));
}

ColumnBox GroundTiles::findObstacles(Column tile) {
  return replace(m_obstacles, tile, obstaclesIn(m_surfaces, tile, m_shape));
}

std::optional<ClearanceMeter::Obstacle> GroundTiles::obstacleNear(Column c, int z) const {
  ObstacleGrid obstacles;
  for (const Column& tile : tilesWithin({{c, c}}, m_shape.largestClearance))
    obstacles.at(tile) = obstaclesIn(m_surfaces, tile, m_shape);
  return m_clearanceMeter.nearest(obstacles, c, z);
}

const GroundComponents& GroundTiles::components() const {
  if (!m_components) m_components = std::make_unique<GroundComponents>(m_surfaces, m_shape);
  return *m_components;
}

}  // namespace semantic_planning
