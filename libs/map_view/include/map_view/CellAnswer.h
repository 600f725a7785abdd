#pragma once
#include <map_view/CellSource.h>

#include <string>

namespace map_view {

/** What the map knows about a cell, in words and numbers for people. */
struct CellAnswer {
  octomap::OcTreeKey key;  ///< of its lowest voxel
  Eigen::Vector3d center;  ///< m, map frame
  double size = 0;         ///< edge, m
  std::string state;       ///< "occupied, road"
  double occupancy = 0;    ///< p(occupied); of a larger cell its most occupied voxel's
  /** A class, or free space, and its share of the cell's distribution. */
  struct Share {
    std::string name;
    ClassId id;  ///< 0: free space
    double probability;
  };
  std::vector<Share> shares;  ///< of 0.0005 and more, the largest first
};

CellAnswer answerOf(const ViewCell& cell, const SemanticOcTree& map);

}  // namespace map_view
