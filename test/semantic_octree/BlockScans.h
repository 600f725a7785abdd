#pragma once
#include "PlainMap.h"
#include "RandomScans.h"

/** Scans of 8 x 8 x 8 voxels (8 blocks) of 1 m, from the origin upwards. They hit single voxels,
 * octants and whole blocks, with one label, several or none, and beam through all of a block or a
 * part. */
class BlockScans {
 public:
  BlockScans(unsigned seed, int classes) : m_random(seed), m_classes(classes) {}

  PosedCloud next() {
    PosedCloud scan;
    scan.T_map_sensor.translation() = Eigen::Vector3d(-6.3, 4.2, 3.7);
    for (int axis = 0; axis < 3; ++axis)
      scan.T_map_sensor.translation()[axis] += between(m_random, -0.2, 0.2);
    if (m_floods == 0 && below(4) == 0) m_floods = 1 + below(8);
    if (m_floods > 0) {
      --m_floods;
      addFlood(scan, 0, 24);
    } else if (const int kind = below(4); kind == 0) {
      addFlood(scan, below(12), 12 + below(12));
    } else if (kind == 1) {
      for (int n = 1 + below(20); n > 0; --n) addCube(scan, 1, below(m_classes + 1));
    } else {
      for (int n = 1 + below(4); n > 0; --n) addCube(scan, kind, below(m_classes + 1));
    }
    return scan;
  }

 private:
  int below(int n) { return static_cast<int>(m_random() % static_cast<unsigned>(n)); }

  void add(PosedCloud& scan, const Eigen::Vector3d& point, int label) {
    scan.cloud.points.push_back((scan.T_map_sensor.inverse() * point).cast<float>());
    scan.cloud.classes.push_back(static_cast<semantic_types::ClassId>(label));
  }
  /** Beams through the region that end behind it. \param low, high part of the back, meters */
  void addFlood(PosedCloud& scan, double low, double high) {
    for (double y = low; y < high; y += 0.4)
      for (double z = 0; z < 24; z += 0.4) add(scan, {12.5, y - 8, z - 8}, 0);
  }
  /** Hits of a voxel, octant or block (size 1, 2, 3: edges of 1, 2, 4). One in four has voxels with
   * labels of their own, one in four has labels in one half only. */
  void addCube(PosedCloud& scan, int size, int label) {
    const int edge = 1 << (size - 1),
              first[] = {below(8 / edge) * edge, below(8 / edge) * edge, below(8 / edge) * edge};
    const int kind = below(4);
    for (int x = 0; x < edge; ++x)
      for (int y = 0; y < edge; ++y)
        for (int z = 0; z < edge; ++z)
          add(scan, {first[0] + x + 0.5, first[1] + y + 0.5, first[2] + z + 0.5},
              kind == 0                    ? below(m_classes + 1)
              : kind == 1 && x >= edge / 2 ? 0
                                           : label);
  }

  std::mt19937 m_random;
  int m_classes, m_floods = 0;
};
