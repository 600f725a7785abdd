#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <random>
#include <string>
#include <vector>

/** A scan and where it was taken. */
struct PosedCloud {
  semantic_types::LabeledCloud cloud;
  Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
};

inline semantic_types::ClassTable numberedClasses(int K) {
  semantic_types::ClassTable table;
  for (int k = 1; k <= K; ++k) table.add("class " + std::to_string(k), {});
  return table;
}

/** Scans of a bumpy ground of several classes with posts on it, seen from a sensor that moves
 * along. \param classes K >= 3 */
inline std::vector<PosedCloud> scansOfSmallPlace(int numScans, int pointsPerScan, int classes,
                                                 unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0.f, 1.f);
  std::vector<PosedCloud> scans;
  for (int s = 0; s < numScans; ++s) {
    PosedCloud scan;
    const Eigen::Vector3d sensor(-3.0 + 1.3 * s, 0.4 * s - 1.0, 1.5);
    scan.T_map_sensor.translation() = sensor;
    scan.T_map_sensor.linear() =
        Eigen::AngleAxisd(0.3 * s, Eigen::Vector3d(0.1, 0.2, 1).normalized()).toRotationMatrix();
    for (int i = 0; i < pointsPerScan; ++i) {
      const float x = -8 + 16 * uniform(random), y = -8 + 16 * uniform(random);
      const bool post = uniform(random) < 0.2f;
      const float z = post ? 2.5f * uniform(random) : 0.1f * std::sin(x);
      const Eigen::Vector3d p =
          post ? Eigen::Vector3d(std::round(x / 4) * 4, std::round(y / 4) * 4, z)
               : Eigen::Vector3d(x, y, z);
      scan.cloud.points.push_back((scan.T_map_sensor.inverse() * p).cast<float>());
      int id = post ? 1 : 2 + (y > 0) % (classes - 1);
      if (uniform(random) < 0.1f) id = static_cast<int>(uniform(random) * (classes + 1));
      scan.cloud.classes.push_back(static_cast<semantic_types::ClassId>(std::min(id, classes)));
    }
    scans.push_back(std::move(scan));
  }
  return scans;
}
