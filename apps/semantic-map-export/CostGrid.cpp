#include "CostGrid.h"

#include <semantic_planning/ground/Ground.h>
#include <strict_files/StrictYaml.h>
#include <strict_files/TextFile.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <stdexcept>

namespace semantic_map_export {

using semantic_planning::Column;
using semantic_planning::Ground;
using semantic_planning::GroundPoint;
using semantic_planning::kTileEdge;
using semantic_planning::Surface;

namespace {

template <class F>
void forEachColumn(const Ground& ground, const F& use) {
  for (const Column tile : ground.tiles()) {
    const Column begin = firstColumnOf(tile), end = lastColumnOf(tile);
    for (int y = begin.y; y <= end.y; ++y)
      for (int x = begin.x; x <= end.x; ++x) use(Column{x, y});
  }
}

/** One of the floors of a building; without a height, all that there is. */
class Storey {
 public:
  Storey(const Ground& ground, std::optional<double> floor, double vehicleHeight) {
    if (!floor) return;
    const double top = ground.voxelSize() / 2;  // of a voxel, above its center
    m_floor = ground.keyOf(*floor - top);
    m_height = static_cast<int>(vehicleHeight / ground.voxelSize());
  }
  /** In voxels. What is a vehicle's height or more from the floor is another storey's. */
  int distance(const Surface& surface) const {
    return m_floor ? std::abs(surface.z - *m_floor) : 0;
  }
  bool has(const Surface& surface) const { return !m_floor || distance(surface) < m_height; }
  bool hasThing(const Ground& ground, Column column) const {
    return m_floor && ground.isOccupied(column, *m_floor + 1, *m_floor + m_height);
  }

 private:
  std::optional<int> m_floor;
  int m_height = 0;
};

/** A place in the part of a storey that hangs together and has the most surfaces. */
GroundPoint placeInLargestPart(const Ground& ground, const Storey& storey) {
  struct Part {
    GroundPoint place;
    std::size_t surfaces;
  };
  std::vector<Part> parts;
  forEachColumn(ground, [&](Column column) {
    for (const Surface& surface : ground.surfaces(column)) {
      if (!surface.drivable || !storey.has(surface)) continue;
      const GroundPoint place{column, surface};
      const auto same = std::find_if(parts.begin(), parts.end(), [&](const Part& part) {
        return ground.connected(part.place, place);
      });
      if (same == parts.end()) {
        parts.push_back({place, 1});
      } else if (++same->surfaces;
                 same != parts.begin() && same->surfaces > std::prev(same)->surfaces) {
        std::iter_swap(same, std::prev(same));  // large ones are asked first
      }
    }
  });
  if (parts.empty()) throw std::runtime_error("the map has no drivable ground");
  return std::max_element(parts.begin(), parts.end(),
                          [](const Part& a, const Part& b) { return a.surfaces < b.surfaces; })
      ->place;
}

class Costs {
 public:
  Costs(const Ground& ground, const colored_graph::ClassOrder& order, double inscribedRadius,
        const Storey& storey)
      : m_ground(ground),
        m_order(order),
        m_radius(inscribedRadius),
        m_storey(storey),
        m_place(placeInLargestPart(ground, storey)) {}

  int at(Column column) const {
    bool isKnown = m_storey.hasThing(m_ground, column);
    const Surface* nearest = nullptr;
    for (const Surface& surface : m_ground.surfaces(column)) {
      if (!m_storey.has(surface)) continue;
      isKnown = true;
      if (!surface.drivable || !m_ground.connected(m_place, {column, surface})) continue;
      if (!nearest || m_storey.distance(surface) < m_storey.distance(*nearest)) nearest = &surface;
    }
    if (nearest) return of(*nearest);
    return isKnown ? CostGrid::kLethal : CostGrid::kUnknown;
  }

 private:
  int of(const Surface& surface) const {
    constexpr int kWorst = 90;
    const colored_graph::Rank rank = m_order.rank(surface.classId);
    if (rank == colored_graph::kForbidden) return CostGrid::kLethal;
    if (!m_ground.hasClearance(surface, m_radius)) return CostGrid::kInscribed;
    return m_order.ranks() > 1 ? kWorst * rank / (m_order.ranks() - 1) : 0;
  }

  const Ground& m_ground;
  const colored_graph::ClassOrder& m_order;
  double m_radius;
  const Storey& m_storey;
  GroundPoint m_place;
};

std::uint8_t grayOf(int cost, CostMode mode) {
  constexpr std::uint8_t kFree = 254, kOccupied = 0, kNeither = 205, kNoCost = 255;
  if (mode == CostMode::Raw)
    return cost == CostGrid::kUnknown ? kNoCost : static_cast<std::uint8_t>(cost);
  if (mode == CostMode::Scale)
    return static_cast<std::uint8_t>(255 - std::lround(2.55 * std::max(cost, 0)));
  if (cost == CostGrid::kUnknown) return kNeither;
  return cost == CostGrid::kLethal ? kOccupied : kFree;
}

std::string pictureOf(const CostGrid& grid, CostMode mode) {
  const bool isTransparent = mode == CostMode::Scale;
  cv::Mat picture(grid.height, grid.width, isTransparent ? CV_8UC4 : CV_8UC1);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const int cost = grid.at(column, grid.height - 1 - row);
      const std::uint8_t gray = grayOf(cost, mode);
      if (isTransparent)
        picture.at<cv::Vec4b>(row, column) = {gray, gray, gray,
                                              std::uint8_t(cost == CostGrid::kUnknown ? 0 : 255)};
      else
        picture.at<std::uint8_t>(row, column) = gray;
    }
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(endingOf(mode), picture, bytes))
    throw std::runtime_error("cannot encode the grid");
  return {bytes.begin(), bytes.end()};
}

}  // namespace

const char* endingOf(CostMode mode) { return mode == CostMode::Scale ? ".png" : ".pgm"; }

CostGrid costGridOf(const semantic_octree::SemanticOcTree& map,
                    const colored_graph::ClassOrder& order,
                    const semantic_planning::VehicleOptions& vehicle, std::optional<double> floor) {
  const Ground ground(map, vehicle, {}, order);
  const Storey storey(ground, floor, vehicle.height);
  const Costs costs(ground, order, vehicle.footprint.inscribedRadius(), storey);
  const std::vector<Column> tiles = ground.tiles();
  Column low = tiles.front(), high = tiles.front();
  for (const Column tile : tiles) {
    low = {std::min(low.x, tile.x), std::min(low.y, tile.y)};
    high = {std::max(high.x, tile.x), std::max(high.y, tile.y)};
  }
  const Column first = firstColumnOf(low);
  CostGrid grid;
  grid.resolution = ground.voxelSize();
  grid.xMin = ground.centerOf(first.x) - grid.resolution / 2;
  grid.yMin = ground.centerOf(first.y) - grid.resolution / 2;
  grid.width = (high.x - low.x + 1) * kTileEdge;
  grid.height = (high.y - low.y + 1) * kTileEdge;
  constexpr std::int64_t kMostCells = std::int64_t{1} << 28;
  if (std::int64_t{grid.width} * grid.height > kMostCells)
    throw std::runtime_error("a grid of " + std::to_string(grid.width) + " x " +
                             std::to_string(grid.height) +
                             " cells is too wide: crop the map first");
  grid.cells.assign(std::size_t(grid.width) * std::size_t(grid.height), CostGrid::kUnknown);
  forEachColumn(ground, [&](Column column) {
    grid.cells[std::size_t(column.y - first.y) * std::size_t(grid.width) +
               std::size_t(column.x - first.x)] = static_cast<std::int8_t>(costs.at(column));
  });
  return grid;
}

CostFiles filesOf(const CostGrid& grid, CostMode mode, const std::string& pictureName) {
  std::ostringstream yaml;
  const strict_files::ClassicNumbers classic(yaml);
  const bool isScaled = mode == CostMode::Scale;
  yaml << "image: " << strict_files::yamlText(pictureName) << "\nmode: "
       << (isScaled                ? "scale"
           : mode == CostMode::Raw ? "raw"
                                   : "trinary")
       << "\nresolution: " << grid.resolution << "\norigin: [" << grid.xMin << ", " << grid.yMin
       << ", 0]\noccupied_thresh: " << (isScaled ? 0.995 : 0.65)
       << "\nfree_thresh: " << (isScaled ? 0.005 : 0.196) << "\nnegate: 0\n";
  return {pictureOf(grid, mode), yaml.str()};
}

}  // namespace semantic_map_export
