#pragma once
#include <gtest/gtest.h>
#include <map_view/OrbitCamera.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/TreeFile.h>

#include <opencv2/imgcodecs.hpp>

#include <algorithm>

#include "Classes.h"
#include "RunProgram.h"
#include "TemporaryFolder.h"
#include "XServer.h"

using semantic_octree::SemanticOcTree;

inline const std::string kViewer = std::string(MSO_BIN_DIR) + "/semantic-map-view";
constexpr int kWidth = 900, kHeight = 700;
constexpr semantic_types::Color kRoad{90, 90, 200}, kGrass{60, 200, 60}, kWall{200, 60, 60};

/** Voxels of 0.2 m around the origin: in the west road, in the east grass, 10 m x 10 m each. Amid
 * the grass is a block of wall, 2 m high. */
inline SemanticOcTree smallMap() {
  semantic_types::LabeledCloud cloud;
  const auto add = [&](float x, float y, float z, semantic_types::ClassId id) {
    cloud.points.emplace_back(x, y, z - 6);
    cloud.classes.push_back(id);
  };
  for (float x = -9.9f; x < 10; x += 0.2f)
    for (float y = -4.9f; y < 5; y += 0.2f) {
      const bool wall = x > 4 && x < 6 && y > -1 && y < 1;
      add(x, y, 0.1f, wall ? 3 : x < 0 ? 1 : 2);
      for (float z = 0.3f; wall && z < 2; z += 0.2f) add(x, y, z, 3);
    }
  SemanticOcTree map(0.2, tableOf({{"road", kRoad}, {"grass", kGrass}, {"wall", kWall}}));
  Eigen::Isometry3d T_map_sensor(Eigen::Translation3d(0, 0, 6));
  for (int i = 0; i < 3; ++i) map.insert(cloud, T_map_sensor);
  return map;
}

/** From above, north up. */
inline const std::string kTop = "0,0,0,40,-90,90";

class SemanticMapView : public FolderTest {
 protected:
  SemanticMapView() { semantic_octree::saveTree(smallMap(), path("map.semantic")); }

  std::string size() const { return std::to_string(kWidth) + "x" + std::to_string(kHeight); }

  /** The window's picture. */
  cv::Mat draw(const Words& arguments) const {
    succeeded(
        runInX(joined({kViewer}, arguments, {"--size", size(), "-f", "-o", path("view.png")})));
    const cv::Mat picture = cv::imread(path("view.png"));
    EXPECT_EQ(picture.cols, kWidth);
    EXPECT_EQ(picture.rows, kHeight);
    return picture;
  }

  /** Works with the window from above, in steps of view-window.sh. \return what it said */
  std::string work(const Words& arguments, const Words& steps) const {
    return workWith(joined({path("map.semantic")}, arguments), steps);
  }
  /** \param files and options */
  std::string workWith(const Words& files, const Words& steps) const {
    Words command{MSO_SOURCE_DIR "/test/apps/view-window.sh", path("said.txt"), kViewer};
    command = joined(command, files, {"--size", size(), "--camera", kTop, "--"});
#ifdef MSO_DROP_FILES
    command.insert(command.begin(), {"/usr/bin/env", "DROP_FILES=" MSO_DROP_FILES});
#endif
    succeeded(runInX(joined(command, steps)));
    return folder.read("said.txt");
  }
  static std::string at(const cv::Point& p) {
    return std::to_string(p.x) + " " + std::to_string(p.y);
  }

  /** By what the window calls their edges: whether the map's own G-values expand the nodes around a
   * voxel, with weight 1 for each class. */
  std::map<std::string, bool> expandedAround(const std::array<int, 3>& key, double alpha) const {
    SemanticOcTree map = semantic_octree::loadTree(path("map.semantic"));
    semantic_octree::AbstractionOptions options;
    for (const int id : {1, 2, 3})
      options.weights = {
          {tree_abstraction::relevant(map.classes().name(semantic_types::ClassId(id)), 1, {id})},
          alpha};
    setAbstraction(map, options);
    const semantic_octree::Abstraction abstraction(map);
    std::map<std::string, bool> expanded;
    semantic_octree::SemanticOcTreeNode node = map.root();
    for (int depth = 0; node && !node.isLeaf(); ++depth) {
      char edge[20];
      std::snprintf(edge, sizeof edge, "%.3g m", map.getNodeSize(unsigned(depth)));
      expanded[edge] = abstraction.isExpanded(node);
      const auto bit = [&](std::size_t axis) { return key[axis] >> (15 - depth) & 1; };
      node = node.child(bit(0) | bit(1) << 1 | bit(2) << 2);
    }
    return expanded;
  }
};

/** Where kTop shows a place, pixels. */
inline cv::Point pixelOf(double x, double y, double z = 0) {
  const auto camera = map_view::OrbitCamera::ofText(kTop);
  const double scale = camera.focalLength(kHeight) / (camera.distance - z);
  return {int(kWidth / 2.0 + scale * x), int(kHeight / 2.0 - scale * y)};
}

/** Which of the colors it is, in whatever light: 'r'oad, 'g'rass, 'w'all, or nothing. */
inline char classAt(const cv::Mat& picture, const cv::Point& at) {
  const cv::Vec3b c = picture.at<cv::Vec3b>(at);
  if (!cv::Rect({0, 0}, picture.size()).contains(at)) return '?';
  const int most = std::max({c[0], c[1], c[2]}), least = std::min({c[0], c[1], c[2]});
  if (most - least < 40) return ' ';
  return most == c[0] ? 'r' : most == c[1] ? 'g' : 'w';
}
