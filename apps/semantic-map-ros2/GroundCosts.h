#pragma once
#include <colored_graph/ClassOrder.h>
#include <semantic_octree/MapFollower.h>
#include <semantic_planning/ground/Ground.h>
#include <semantic_planning/planner/SemanticPlanner.h>

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace semantic_map_ros2 {

/** What driving over the ground that the robot can reach costs, column by column, as nav2's static
 * layer takes it. It is a rank's cost; 100 where there is another thing or a forbidden class; -1
 * where the map knows nothing. Only what changes is computed. */
class GroundCosts {
 public:
  static constexpr int kUnknown = -1, kBlocked = 100;
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

  /** The map must outlive it. \param costs by rank */
  GroundCosts(semantic_octree::SemanticOcTree& map, const colored_graph::ClassOrder& order,
              const semantic_planning::PlannerOptions& options, std::vector<int> costs);

  /** Follows the map. \param T_map_robot of a frame that may be anywhere on the robot
   * \return around the cells that changed; where box() is another one, all may be others */
  std::optional<Box> follow(const Eigen::Isometry3d& T_map_robot);
  /** How high the robot's frame is above the ground, m; none: no ground was seen yet. */
  std::optional<double> frameHeight() const { return m_height.meters(); }
  /** The box that the cells fill; none: nothing is known. */
  const std::optional<Box>& box() const { return m_box; }
  /** Row by row, the lowest first. */
  std::vector<std::uint8_t>& cells() { return m_cells; }
  std::uint8_t at(Column column) const {
    return m_box && m_box->has(column) ? m_cells[placeOf(column)] : std::uint8_t(kUnknown);
  }
  double voxelSize() const { return m_ground.voxelSize(); }
  /** Center of the columns with a key, m. */
  double centerOf(int key) const { return m_ground.centerOf(key); }

 private:
  using GroundPoint = semantic_planning::GroundPoint;
  /** Ground of a tile, one point for all that is connected within it. */
  struct Part {
    GroundPoint point;
    bool isReached;
  };
  bool grow(const std::vector<Column>& tiles);
  bool isReached(const GroundPoint& point) const {
    return !m_robot || m_ground.connected(*m_robot, point);
  }
  /** \param changed of columns whose costs do */
  void compute(Column tile, std::optional<Box>& changed);
  int costAt(Column column, std::vector<Part>& parts) const;
  std::size_t placeOf(Column c) const {
    return std::size_t(c.y - m_box->low.y) * m_box->width() + c.x - m_box->low.x;
  }

  std::optional<GroundPoint> below(const Eigen::Isometry3d& T_map_robot) const;

  colored_graph::ClassOrder m_order;
  semantic_planning::VehicleOptions m_vehicle;
  semantic_octree::MapFollower m_follower;
  semantic_planning::Ground m_ground;
  std::vector<int> m_costs;
  semantic_planning::FrameHeight m_height;
  std::optional<GroundPoint> m_robot;           ///< none: it stands on nothing that is known
  std::map<Column, std::vector<Part>> m_parts;  ///< of tiles with drivable ground
  std::optional<Box> m_box;
  std::vector<std::uint8_t> m_cells;
};

}  // namespace semantic_map_ros2
