#pragma once
#include <map_folders/MapFolder.h>
#include <semantic_octree/TreeFile.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "RandomScans.h"
#include "TemporaryFolder.h"

namespace folder_drive {

using namespace semantic_octree;

/** All in a ball, of 7 m around a point in whose neighborhood there are tiles of 6.4 m, is free. */
inline PosedCloud denseScan() {
  PosedCloud scan;
  scan.T_map_sensor = Eigen::Isometry3d::Identity();
  scan.T_map_sensor.translation() << 22.4, 3.2, 3.2;
  constexpr int kPoints = 20000;
  for (int i = 0; i < kPoints; ++i) {  // Fibonacci's sphere
    const double z = 1 - (2 * i + 1.0) / kPoints, r = std::sqrt(1 - z * z), angle = 2.4 * i;
    scan.cloud.points.emplace_back(
        7 * Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), z).cast<float>());
  }
  return scan;
}

/** Scans over some tens of meters; in parts of them cubes are free as a whole, and then no more. */
inline std::vector<PosedCloud> someScans(unsigned seed, int number, bool softLabels = false) {
  std::mt19937 random(seed);
  std::vector<PosedCloud> scans;
  RandomScanOptions options;
  options.sensorSpread = 12;
  options.softLabels = softLabels;
  options.points = 300;
  for (int i = 0; i < number; ++i) {
    scans.push_back(i % 4 == 1 ? denseScan() : randomScan(random, options));
    if (i % 4 == 2) scans.back().T_map_sensor.translation().x() += 12;
  }
  return scans;
}

inline AbstractionOptions someAbstraction(double alpha = 0.01) {
  AbstractionOptions options;
  options.weights = {
      {tree_abstraction::relevant("1", 1, {1}), tree_abstraction::irrelevant("2", 0.5, {2})},
      alpha};
  return options;
}

inline SemanticOcTree emptyMap(bool pruning = true) {
  SemanticOcTree map(0.4, numberedClasses(5));
  map.setPruning(pruning);
  return map;
}

inline void insertAll(SemanticOcTree& map, const std::vector<PosedCloud>& scans, int threads = 1) {
  InsertionOptions options;
  options.threads = threads;
  for (const PosedCloud& scan : scans) map.insert(scan.cloud, scan.T_map_sensor, options);
}

inline std::string bytesOf(const SemanticOcTree& map) {
  std::ostringstream out;
  writeTree(out, map);
  return out.str();
}

/** Nearly nothing stays in memory. */
inline MapFolderOptions tight(double tileSize = 6.4) {
  MapFolderOptions options;
  options.memory = 0.02;
  options.tileSize = tileSize;
  return options;
}

constexpr auto kRead = MapFolder::Access::Read, kWrite = MapFolder::Access::Write;

/** Saves a map of these scans. */
inline void saveScans(const std::filesystem::path& folder, const std::vector<PosedCloud>& scans,
                      double tileSize = 6.4) {
  SemanticOcTree map = emptyMap();
  MapFolder tiles(map, folder, kWrite, tight(tileSize));
  insertAll(map, scans);
  tiles.save();
}

/** Paths of tiles' files, sorted. */
inline std::vector<std::filesystem::path> tileFiles(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().filename().string().rfind("tile_", 0) == 0) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

inline std::string contentOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void write(const std::filesystem::path& file, const std::string& content) {
  std::ofstream(file, std::ios::binary) << content;
}

/** A tile's place, which its file's name tells. */
inline Eigen::Vector3d placeOf(const std::filesystem::path& file) {
  Eigen::Vector3i at = Eigen::Vector3i::Constant(1000000);
  std::sscanf(file.filename().c_str(), "tile_%d_%d_%d.", &at.x(), &at.y(), &at.z());
  return at.cast<double>();
}

}  // namespace folder_drive
