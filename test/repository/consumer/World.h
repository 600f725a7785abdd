#pragma once
#include <semantic_types/LabeledCloud.h>

#include <Eigen/Geometry>

/** What a robot's driver and its segmentation network would deliver: here a road along x with grass
 * on both sides and a wall across. */
namespace world {

constexpr semantic_types::ClassId kRoad = 1, kGrass = 2, kWall = 3;

/** A scan with a class for each point. */
semantic_types::LabeledCloud scanFrom(const Eigen::Isometry3d& T_map_sensor);

}  // namespace world
