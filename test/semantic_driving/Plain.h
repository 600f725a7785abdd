#pragma once
#include <semantic_planning/planner/OrderFile.h>
#include <synthetic_world/Objects.h>
#include <synthetic_world/Solids.h>

#include "simulated_drive/DriveConfig.h"

/** The robot of config/drives with sensors of few points. */
inline simulated_drive::DriveConfig smallConfig() {
  auto config = simulated_drive::loadDriveConfig(std::string(MSO_SOURCE_DIR) +
                                                 "/config/drives/synthetic.ini");
  config.sensors.camera.width = 80;
  config.sensors.camera.height = 60;
  config.sensors.lidar.columns = 256;
  config.insertion.maxRange = 10;
  config.planner.roadmap.vertices = 600;
  config.timeLimit = 90;
  return config;
}

inline colored_graph::ClassOrder syntheticOrder() {
  return semantic_planning::loadClassOrder(
      std::string(MSO_SOURCE_DIR) + "/config/orders/synthetic.yaml", synthetic_world::classTable());
}

/** Flat grass 40 m wide, with a road along x that is `width` wide, and things on it. */
inline synthetic_world::World plain(synthetic_world::Solids solids = {}, double width = 8) {
  synthetic_world::GroundCover cover(20, synthetic_world::kGrass);
  cover.paintBand(synthetic_world::kRoad, {-18, 0}, {18, 0}, width);
  return synthetic_world::World(synthetic_world::Terrain(20, {}), cover, std::move(solids));
}

inline void addWall(synthetic_world::Solids& solids, const Eigen::Vector2d& a,
                    const Eigen::Vector2d& b) {
  const auto wall = synthetic_world::wallPanel({a.x(), a.y(), 0}, {b.x(), b.y(), 0}, 2);
  solids.insert(solids.end(), wall.begin(), wall.end());
}
