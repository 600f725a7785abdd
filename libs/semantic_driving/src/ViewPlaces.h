#pragma once
#include <semantic_driving/ViewStrategy.h>

#include <optional>
#include <vector>

#include "GroundFlood.h"

namespace semantic_driving {

/** A place that the vehicle can get to. */
struct ViewPlace {
  semantic_planning::Column column;
  int z = 0;          ///< key of the ground
  double length = 0;  ///< meters of the way that costs least
  /** Headings of that way, radians; none: the vehicle is there. */
  std::optional<double> departure, arrival;
};

/** Places in the area on ground that can be reached, about 1.6 m apart, nearest first; always the
 * same ones of the map. */
std::vector<ViewPlace> placesOf(const GroundFlood& flood, const semantic_planning::Ground& ground,
                                const Eigen::AlignedBox2d& area);

/** Meters to look from a place, with what turning takes. \param from, to headings, radians */
double wayTo(const ViewPlace& place, double from, double to, double turningRadius);

/** Towards the unknown ground that is in sight within 2 m, radians; nothing: there is none. */
std::optional<double> headingToUnknown(const semantic_planning::Ground& ground,
                                       const ViewPlace& place);

/** Views that were done, and those like them. */
class DoneViews {
 public:
  void add(const mrpt::math::TPose2D& pose) { m_done.push_back(pose); }
  /** \param width of the sensor's view, radians */
  bool has(const mrpt::math::TPose2D& pose, double width) const;
  std::size_t size() const { return m_done.size(); }

 private:
  std::vector<mrpt::math::TPose2D> m_done;
};

/** Meters from place to place by way of the flood's tree. */
double wayBetween(const GroundFlood& flood, double voxelSize, semantic_planning::Column a,
                  semantic_planning::Column b);

/** The order of stops in which most is had soonest: least sum of legs' lengths times what is
 * missing (the weighted traveling repairman's). Exact, for at most 12 stops.
 * \param ways[i][j] from stop i to j; the last row is from where the vehicle is
 * \param worth of each stop \return the stop to go to first */
std::size_t firstStop(const std::vector<std::vector<double>>& ways,
                      const std::vector<double>& worth);

}  // namespace semantic_driving
