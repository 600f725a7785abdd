#pragma once
#include <ground_costs/GroundCosts.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <semantic_octree/SemanticOcTree.h>

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

/** What driving costs, column by column, as ground_costs::GroundCosts has it. */
struct Grid {
  static constexpr int kUnknown = ground_costs::GroundCosts::kUnknown,
                       kLethal = ground_costs::GroundCosts::kBlocked;
  double resolution = 0;            ///< edge of a cell, m
  double xMin = 0, yMin = 0;        ///< lower left corner, m, map frame
  int width = 0, height = 0;        ///< cells
  std::vector<std::uint8_t> cells;  ///< rows from below; kUnknown is 255

  int at(int column, int row) const {
    return static_cast<std::int8_t>(
        cells[std::size_t(row) * std::size_t(width) + std::size_t(column)]);
  }
};

Grid gridOf(const ground_costs::GroundCosts& costs);
/** What is in a vehicle's way, whatever its class: kLethal where something is higher above the
 * ground than its step and lower than its top, free where nothing is, as far as that was seen. The
 * ground is the lowest occupied voxel of each column; what stands out of it and is narrower than
 * 4 m is none. (That of planners climbs fences whose class it does not know, for single voxels are
 * stairs.) \param floor the ground is flat and at this height (m), and need not be in the map
 * \throw std::runtime_error the map is empty or too wide */
Grid gridOf(const semantic_octree::SemanticOcTree& map,
            const semantic_planning::VehicleOptions& vehicle, std::optional<double> floor);

mrpt::maps::COccupancyGridMap2D occupancyOf(const Grid& grid);

/** For ROS's map_server: bytes of a picture, as its ending says, and its description. */
std::string pictureOf(const Grid& grid, CostMode mode, const std::string& ending);
std::string yamlOf(const Grid& grid, CostMode mode, const std::string& pictureName);

}  // namespace semantic_map_export
