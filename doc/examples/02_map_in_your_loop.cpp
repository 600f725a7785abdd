// Makes a map of scans, one after the other, and keeps its compressed form up to date:
//     02_map_in_your_loop OUTPUT.semantic
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/TreeFile.h>
#include <synthetic_world/Scene.h>
#include <synthetic_world/Sensors.h>

#include <iostream>

int main(int argc, char** argv) try {
  if (argc != 2) throw std::invalid_argument("expected the name of the map");
  const synthetic_world::Scene village = synthetic_world::makeScene("village", 1);

  // Voxels of 0.2 m. The compressed form keeps what tells where the road is, at a price for detail.
  semantic_octree::SemanticOcTree map(0.2, synthetic_world::classTable());
  semantic_octree::AbstractionOptions options;
  options.weights = {{tree_abstraction::relevant("road", 1.0, {synthetic_world::kRoad})}, 0.01};
  setAbstraction(map, options);
  semantic_octree::LeafFollower follower(map);

  for (double s = 0; s < 40; s += 4) {
    // Your localization and your LiDAR or camera: here they are made up.
    const Eigen::Vector2d p = village.route.at(s);
    const Eigen::Isometry3d T_map_sensor =
        village.world.poseOnGround(p.x(), p.y(), village.route.heading(s)) *
        Eigen::Translation3d(0, 0, 1.5);
    const semantic_types::LabeledCloud cloud = scanLidar(village.world, T_map_sensor, {});
    map.insert(cloud, T_map_sensor);
    const auto change = follower.leaves();  // all that another robot needs to be told
    std::cout << cloud.size() << " points, " << map.getNumLeafNodes()
              << " leaves; compressed: " << change.added.size() << " came, "
              << change.removed.size() << " went\n";
  }
  semantic_octree::saveTree(map, argv[1]);
} catch (const std::exception& e) {
  std::cerr << "error: " << e.what() << "\n";
  return 1;
}
