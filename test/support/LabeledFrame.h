#pragma once
#include <semantic_types/LabeledCloud.h>

#include <Eigen/Geometry>
#include <vector>

/** One scan of a data set, with what it takes to insert it and to judge a map by it. */
struct LabeledFrame {
  semantic_types::LabeledCloud cloud;
  Eigen::Isometry3d T_map_sensor;
  /** Per point: whether it belongs to a moving object. Empty: none does. */
  std::vector<bool> moving;

  bool isMoving(std::size_t point) const { return !moving.empty() && moving[point]; }
};
