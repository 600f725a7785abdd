#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "DataSets.h"

namespace {

namespace fs = std::filesystem;

template <typename T>
std::vector<T> readBinary(const fs::path& file) {
  std::vector<T> values(fs::file_size(file) / sizeof(T));
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(values.data()),
          static_cast<std::streamsize>(values.size() * sizeof(T)));
  if (!in) throw std::runtime_error("cannot read " + file.string());
  return values;
}

/** 12 numbers of a row-major 3 x 4 matrix. */
Eigen::Isometry3d readPose(std::istream& in) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) in >> T.matrix()(row, column);
  return T;
}

Eigen::Isometry3d readCameraFromLidar(const fs::path& calib) {
  std::ifstream in(calib);
  for (std::string word; in >> word;)
    if (word == "Tr:") return readPose(in);
  throw std::runtime_error(calib.string() + " has no Tr");
}

bool isMovingClass(std::uint32_t rawId) { return rawId >= 252 && rawId <= 259; }

LabeledFrame readFrame(const fs::path& sequence, const std::string& name,
                       const semantic_types::ClassTable& table) {
  LabeledFrame frame;
  const auto xyzr = readBinary<Eigen::Vector4f>(sequence / "velodyne" / (name + ".bin"));
  const auto labels = readBinary<std::uint32_t>(sequence / "labels" / (name + ".label"));
  for (std::size_t i = 0; i < xyzr.size(); ++i) {
    const std::uint32_t rawId = labels.at(i) & 0xffff;
    frame.cloud.points.push_back(xyzr[i].head<3>());
    frame.cloud.classes.push_back(table.fromRaw(rawId));
    frame.moving.push_back(isMovingClass(rawId));
  }
  return frame;
}

}  // namespace

std::vector<LabeledFrame> readSemanticKitti(const fs::path& sequence,
                                            const semantic_types::ClassTable& table) {
  const Eigen::Isometry3d T_camera_lidar = readCameraFromLidar(sequence / "calib.txt");
  std::vector<LabeledFrame> frames;
  std::ifstream poses(sequence / "poses.txt");
  for (std::string line; std::getline(poses, line);) {
    char name[24];
    std::snprintf(name, sizeof(name), "%06zu", frames.size());
    frames.push_back(readFrame(sequence, name, table));
    std::istringstream numbers(line);
    // The first camera looks along z: undo that, so that the map's z axis points up.
    frames.back().T_map_sensor = T_camera_lidar.inverse() * readPose(numbers) * T_camera_lidar;
  }
  return frames;
}
