#pragma once
#include <labeled_cloud/CObservationLabeledCloud.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <semantic_map/CSemanticOctoMap.h>

#include <string>

#include "Classes.h"

/** road (red), tree (green), wall (blue) */
inline semantic_types::ClassTable threeClasses() {
  return tableOf({{"road", {200, 30, 30}}, {"tree", {30, 180, 60}}, {"wall", {40, 60, 210}}});
}

inline labeled_cloud::CObservationLabeledCloud labeledPoints(
    const std::vector<Eigen::Vector3f>& points,
    const std::vector<semantic_types::ClassId>& classes) {
  labeled_cloud::CObservationLabeledCloud observation;
  observation.cloud.points = points;
  observation.cloud.classes = classes;
  observation.sensorLabel = "lidar";
  return observation;
}

inline semantic_map::TAbstractionOptions someAbstraction() {
  semantic_map::TAbstractionOptions options;
  options.relevant = "road: 1, tree: 0.5";
  options.weights.alpha = 0.02;
  options.blockSize = 0.8;
  return options;
}

/** Points of all three classes around the robot, some seen from two poses. */
inline void fill(semantic_map::CSemanticOctoMap& map) {
  std::vector<Eigen::Vector3f> points;
  std::vector<semantic_types::ClassId> classes;
  for (int i = 0; i < 400; ++i) {
    const float angle = 0.1f * float(i);
    points.emplace_back(5 * std::cos(angle), 4 * std::sin(angle), 0.01f * float(i) - 1);
    classes.push_back(static_cast<semantic_types::ClassId>(i % 4));
  }
  map.insertObservation(labeledPoints(points, classes),
                        mrpt::poses::CPose3D(0.3, 0.2, 1, 0.5, 0, 0));
  map.insertObservation(labeledPoints(points, classes),
                        mrpt::poses::CPose3D(0.5, 0.2, 1, 0.6, 0.1, 0));
}

/** All that an archive holds of an object. */
inline std::string bytesOf(const mrpt::serialization::CSerializable& object) {
  mrpt::io::CMemoryStream stream;
  mrpt::serialization::archiveFrom(stream) << object;
  return {static_cast<const char*>(stream.getRawBufferData()), stream.getTotalBytesCount()};
}

inline void readBytes(mrpt::serialization::CSerializable& object, const std::string& bytes) {
  mrpt::io::CMemoryStream stream;
  stream.assignMemoryNotOwn(bytes.data(), bytes.size());
  mrpt::serialization::archiveFrom(stream).ReadObject(&object);
}
