#pragma once
#include <colored_graph/ClassOrder.h>
#include <semantic_octree/MapFollower.h>
#include <semantic_planning/ground/Ground.h>
#include <semantic_planning/planner/SemanticPlanner.h>

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace ground_costs {

/** Costs from 0 (best) evenly to 90. */
std::vector<int> evenCosts(int ranks);

/** What driving over the ground that can be reached costs, column by column, as nav2's static layer
 * takes it. It is a rank's cost; kBlocked where there is another thing, ground apart, or a
 * forbidden class; kUnknown where the map knows nothing. If a column has several levels that can be
 * reached, the lowest counts. Only what changes is computed. */
class GroundCosts {
 public:
  static constexpr int kUnknown = -1, kInscribed = 99, kBlocked = 100;
  using Column = semantic_planning::Column;
  /** Columns from the lowest to the highest. */
  struct Box {
    Column low, high;
    int width() const { return high.x - low.x + 1; }
    int height() const { return high.y - low.y + 1; }
    bool has(Column c) const {
      return c.x >= low.x && c.x <= high.x && c.y >= low.y && c.y <= high.y;
    }
    bool operator==(const Box& o) const { return low == o.low && high == o.high; }
    void add(Column c);
  };

  /** The map must outlive it. \param costs by rank; none: evenCosts()
   * \throw std::invalid_argument an order of other classes, or a bad vehicle */
  GroundCosts(semantic_octree::SemanticOcTree& map, const colored_graph::ClassOrder& order,
              const semantic_planning::PlannerOptions& options, std::vector<int> costs);

  /** Follows the map, and a robot whose ground can be reached; all can, as long as it stands on
   * nothing that is known. \param T_map_robot of a frame that may be anywhere on the robot
   * \return around the cells that changed; where box() is another one, all may be others
   * \throw std::runtime_error the map is too wide */
  std::optional<Box> follow(const Eigen::Isometry3d& T_map_robot);
  /** Instead of a robot's ground it is the connected part with the most surfaces, and costs
   * kInscribed where the vehicle's inscribed disc does not fit; forbidden classes do not matter for
   * that. \param floor m, map frame: of the storey that counts. It has what is less than
   * the vehicle's height away, and of several levels the nearest counts.
   * \throw std::runtime_error there is no drivable ground, or the map is too wide */
  void takeLargestPart(std::optional<double> floor);
  /** The box that the cells fill; none: nothing is known. */
  const std::optional<Box>& box() const { return m_box; }
  /** Row by row, the lowest first; kUnknown is 255. */
  const std::vector<std::uint8_t>& cells() const { return m_cells; }
  std::uint8_t at(Column column) const {
    return m_box && m_box->has(column) ? m_cells[placeOf(column)] : std::uint8_t(kUnknown);
  }
  double voxelSize() const { return m_ground.voxelSize(); }
  /** Lower border of the columns with a key, m. */
  double borderOf(int key) const { return m_ground.centerOf(key) - voxelSize() / 2; }

 private:
  using GroundPoint = semantic_planning::GroundPoint;
  using Surface = semantic_planning::Surface;
  /** Ground of a tile, one point for all that is connected within it. */
  struct Part {
    GroundPoint point;
    bool isReached;
  };
  std::optional<Box> compute(std::vector<Column> tiles, const std::optional<GroundPoint>& from);
  bool grow(const std::vector<Column>& tiles);
  bool isReached(const GroundPoint& point) const {
    return !m_from || m_ground.connected(*m_from, point);
  }
  bool counts(Column column, const Surface& surface, std::vector<Part>& parts) const;
  void computeTile(Column tile, std::optional<Box>& changed);
  int costAt(Column column, std::vector<Part>& parts) const;
  std::size_t placeOf(Column c) const {
    return std::size_t(c.y - m_box->low.y) * m_box->width() + c.x - m_box->low.x;
  }
  std::optional<GroundPoint> below(const Eigen::Isometry3d& T_map_robot) const;
  GroundPoint inLargestPart() const;
  /** In voxels; 0 without a floor. */
  int aboveFloor(const Surface& surface) const { return m_floor ? surface.z - *m_floor : 0; }
  bool isInStorey(const Surface& surface) const {
    return !m_floor || std::abs(aboveFloor(surface)) < m_storeyHeight;
  }

  colored_graph::ClassOrder m_order;
  semantic_planning::VehicleOptions m_vehicle;
  semantic_octree::MapFollower m_follower;
  semantic_planning::Ground m_ground;
  std::vector<int> m_costs;
  std::optional<int> m_floor;  ///< key
  int m_storeyHeight = 0;      ///< voxels
  bool m_isInscribed = false;
  semantic_planning::FrameHeight m_height;
  std::optional<GroundPoint> m_from;            ///< what is connected with it is reached; none: all
  std::map<Column, std::vector<Part>> m_parts;  ///< of tiles with drivable ground
  std::optional<Box> m_box;
  std::vector<std::uint8_t> m_cells;
};

}  // namespace ground_costs
