#include "RandomScans.h"

#include <cmath>
#include <limits>

using semantic_types::ClassId;

double between(std::mt19937& random, double low, double high) {
  return low + (high - low) * std::ldexp(static_cast<double>(random()), -32);
}

Eigen::Isometry3d randomPose(std::mt19937& random, double spread) {
  Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
  Eigen::Vector4d q;
  for (int i = 0; i < 4; ++i) q[i] = between(random, -1, 1);
  T_map_sensor.linear() = Eigen::Quaterniond(q.normalized()).toRotationMatrix();
  for (int i = 0; i < 3; ++i) T_map_sensor.translation()[i] = between(random, -spread, spread);
  return T_map_sensor;
}

namespace {

void addLabel(std::mt19937& random, const RandomScanOptions& o,
              semantic_types::LabeledCloud& cloud) {
  const bool unlabeled = between(random, 0, 1) < o.unlabeledShare;
  if (!o.softLabels) {
    cloud.classes.push_back(unlabeled ? 0 : static_cast<ClassId>(1 + random() % o.classes));
    return;
  }
  std::vector<float> q(o.classes, 0.f);
  float sum = 0;
  for (float& x : q) sum += x = static_cast<float>(unlabeled ? 0 : between(random, 0.01, 1));
  for (const float x : q) cloud.probabilities.push_back(unlabeled ? 0 : x / sum);
}

}  // namespace

PosedCloud randomScan(std::mt19937& random, const RandomScanOptions& o) {
  PosedCloud scan;
  scan.T_map_sensor = randomPose(random, o.sensorSpread);
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (int i = 0; i < o.points; ++i) {
    if (i % 4 == 0) {
      Eigen::Vector3d direction;
      for (int axis = 0; axis < 3; ++axis) direction[axis] = between(random, -1, 1);
      center = direction.normalized() * between(random, 0, o.reach);
    }
    Eigen::Vector3f p = center.cast<float>();
    for (int axis = 0; axis < 3; ++axis) p[axis] += static_cast<float>(between(random, -0.1, 0.1));
    if (between(random, 0, 1) < o.notFiniteShare)
      p[random() % 3] = random() % 2 ? std::numeric_limits<float>::quiet_NaN()
                                     : std::numeric_limits<float>::infinity();
    scan.cloud.points.push_back(p);
    addLabel(random, o, scan.cloud);
  }
  return scan;
}
