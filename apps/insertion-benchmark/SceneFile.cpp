#include <fstream>
#include <stdexcept>

#include "Scene.h"

namespace insertion_benchmark {
namespace {

class SceneReader {
 public:
  explicit SceneReader(const std::filesystem::path& file)
      : m_file(file), m_in(file, std::ios::binary) {
    if (!m_in) fail("cannot be opened");
  }

  template <typename T>
  T get() {
    T value;
    read(&value, sizeof(T));
    return value;
  }

  PosedScan scan() {
    PosedScan scan;
    scan.T_map_sensor = pose();
    for (auto left = get<std::uint32_t>(); left > 0; --left) {
      Eigen::Vector3f& point = scan.cloud.points.emplace_back();
      read(point.data(), 3 * sizeof(float));
      const auto label = get<std::uint16_t>();
      if (label > semantic_types::kMaxClasses) fail("label " + std::to_string(label));
      scan.cloud.classes.push_back(static_cast<semantic_types::ClassId>(label));
    }
    return scan;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error("scene '" + m_file.string() + "': " + what);
  }
  void read(void* to, std::size_t bytes) {
    if (!m_in.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes))) fail("truncated");
  }
  Eigen::Isometry3d pose() {
    Eigen::Matrix<double, 4, 4, Eigen::RowMajor> m;
    read(m.data(), 16 * sizeof(double));
    const Eigen::Matrix3d rotation = m.topLeftCorner<3, 3>();
    if (!((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3))
      fail("a pose that is none");
    Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
    T_map_sensor.matrix() = m;
    return T_map_sensor;
  }

  std::filesystem::path m_file;
  std::ifstream m_in;
};

}  // namespace

std::size_t Scene::numPoints() const {
  std::size_t n = 0;
  for (const PosedScan& scan : scans) n += scan.cloud.size();
  return n;
}

Scene readSceneFile(const std::filesystem::path& file, std::size_t maxScans) {
  SceneReader reader(file);
  std::size_t numScans = reader.get<std::uint32_t>();
  if (maxScans > 0) numScans = std::min(numScans, maxScans);
  Scene scene;
  while (scene.scans.size() < numScans) {
    scene.scans.push_back(reader.scan());
    for (const int id : scene.scans.back().cloud.classes)
      scene.numClasses = std::max(scene.numClasses, id);
  }
  return scene;
}

}  // namespace insertion_benchmark
