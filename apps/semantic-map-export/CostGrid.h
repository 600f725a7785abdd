#pragma once
#include <colored_graph/ClassOrder.h>
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_planning/vehicle/VehicleOptions.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace semantic_map_export {

/** How pictures of map_server hold costs. */
enum class CostMode {
  Trinary,  ///< lethal, unknown or neither
  Scale,    ///< costs as shades of gray, unknown transparent
  Raw       ///< costs as numbers, 255: unknown
};

/** What driving over the ground costs, column by column. */
struct CostGrid {
  static constexpr int kInscribed = 99, kLethal = 100, kUnknown = -1;

  double resolution = 0;           ///< edge of a cell, m
  double xMin = 0, yMin = 0;       ///< lower left corner, m, map frame
  int width = 0, height = 0;       ///< cells
  std::vector<std::int8_t> cells;  ///< rows from below: 0 to 100, or kUnknown

  int at(int column, int row) const {
    return cells[std::size_t(row) * std::size_t(width) + std::size_t(column)];
  }
};

/** The ground is the connected part with the most surfaces. If a column has several levels, the
 * lowest counts. With a floor (m, map frame) it is the level nearest to that, less than the
 * vehicle's height away. A rank costs from 0 (best) evenly to 90. kInscribed: the vehicle's origin
 * cannot be there, as its inscribed disc would leave the ground. Forbidden classes do not matter
 * for that. kLethal: ground apart, forbidden classes, and what stands there. kUnknown: the map
 * knows nothing.
 * \throw std::runtime_error the map has no drivable ground, or is too wide
 * \throw std::invalid_argument an order of other classes, or a bad vehicle */
CostGrid costGridOf(const semantic_octree::SemanticOcTree& map,
                    const colored_graph::ClassOrder& order,
                    const semantic_planning::VehicleOptions& vehicle, std::optional<double> floor);

/** A picture and its description, for ROS's map_server. */
struct CostFiles {
  std::string picture;  ///< bytes: PGM, but PNG for CostMode::Scale, as PGM has no transparency
  std::string yaml;     ///< text
};
const char* endingOf(CostMode mode);
CostFiles filesOf(const CostGrid& grid, CostMode mode, const std::string& pictureName);

}  // namespace semantic_map_export
