#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <opencv2/core.hpp>

#include "Classes.h"

constexpr semantic_types::Color kRoad{200, 30, 30}, kTree{30, 180, 60}, kWall{40, 60, 210};

inline cv::Vec3b pixelOf(const semantic_types::Color& c) { return {c.b, c.g, c.r}; }

/** How many pixels have the color. */
inline int count(const cv::Mat& picture, const semantic_types::Color& c) {
  cv::Mat mask;
  cv::inRange(picture, cv::Scalar(c.b, c.g, c.r), cv::Scalar(c.b, c.g, c.r), mask);
  return cv::countNonZero(mask);
}

/** road (red), tree (green), wall (blue) */
inline semantic_types::ClassTable paintedClasses() {
  return tableOf({{"road", kRoad}, {"tree", kTree}, {"wall", kWall}});
}

/** A field of 10 m x 6 m at z = 0.1 m with voxels of 0.2 m: its western half is road, the eastern
 * one trees; and that high above it, if it is not 0, a wall over all of it. \param corner in the
 * southwest, m */
inline semantic_octree::SemanticOcTree paintedField(const Eigen::Vector2d& corner = {0, 0},
                                                    float wallHeight = 0) {
  semantic_types::LabeledCloud cloud;
  const auto add = [&](float x, float y, float z, semantic_types::ClassId id) {
    cloud.points.emplace_back(x + float(corner.x()), y + float(corner.y()), z);
    cloud.classes.push_back(id);
  };
  for (float x = 0.1f; x < 10; x += 0.2f)
    for (float y = 0.1f; y < 6; y += 0.2f) {
      add(x, y, -0.9f, x < 5 ? 1 : 2);
      if (wallHeight > 0) add(x, y, wallHeight - 0.9f, 3);
    }
  semantic_octree::SemanticOcTree tree(0.2, paintedClasses());
  Eigen::Isometry3d T_map_sensor(Eigen::Translation3d(0, 0, 1));
  tree.insert(cloud, T_map_sensor);
  return tree;
}
