#include "Readers.h"

#include <labeled_cloud/LabelFolder.h>
#include <labeled_cloud/LabelModel.h>
#include <labeled_cloud/NetworkLabeler.h>
#include <labeled_cloud/PointFile.h>
#include <labeled_cloud/RawlogReader.h>
#include <labeled_cloud/ScanConverter.h>
#include <labeled_cloud/Trajectory.h>
#include <octomap/OcTree.h>
#include <semantic_map/ImportOctomap.h>
#include <semantic_octree/TreeFile.h>
#include <semantic_octree/WeightsFile.h>
#include <semantic_planning/planner/OrderFile.h>
#include <semantic_planning/vehicle/VehicleFile.h>
#include <semantic_types/ClassTableFile.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace {

namespace fs = std::filesystem;
using semantic_types::ClassTable;

const ClassTable& classes() {
  static const ClassTable table = [] {
    ClassTable t;
    for (const char* name : {"road", "grass", "building", "tree"}) t.add(name, {});
    return t;
  }();
  return table;
}

/** For functions that want a file: the bytes are one, with an ending of their choice. */
template <typename F>
auto fromFile(const std::string& ending, const F& read) {
  return [ending, read](const std::string& bytes) {
    const fs::path file =
        fs::temp_directory_path() / ("mso_fuzz_" + std::to_string(getpid()) + ending);
    std::ofstream(file, std::ios::binary) << bytes;
    try {
      read(file);
    } catch (...) {
      fs::remove(file);
      throw;
    }
    fs::remove(file);
  };
}

void readMap(const std::string& bytes) {
  std::istringstream in(bytes);
  const semantic_octree::SemanticOcTree map = semantic_octree::readTree(in);
  std::ostringstream out;
  semantic_octree::writeTree(out, map);
  std::istringstream again(out.str());
  if (!(semantic_octree::readTree(again) == map)) std::abort();
}

void readRawlog(const fs::path& file) {
  labeled_cloud::RawlogReader reader(file);
  labeled_cloud::ScanConverter converter(classes());
  semantic_octree::InsertionOptions options;
  options.maxScanMemory = 100;
  while (const auto entry = reader.next())
    for (const auto& observation : entry->observations) try {
        const auto scan = converter.convert(*observation);
        if (!scan) continue;
        semantic_octree::SemanticOcTree map(1, classes());
        map.insert(scan->cloud, Eigen::Isometry3d::Identity(), options);
      } catch (const std::exception&) {
        continue;
      }
}

}  // namespace

const std::vector<Reader>& readers() {
  static const std::vector<Reader> all = {
      {"map", readMap, {}},
      {"rawlog", fromFile(".rawlog", readRawlog), {}},
      {"octomap", fromFile(".ot", semantic_map::readOctomapFile), {}},
      {"octomap-binary", fromFile(".bt", semantic_map::readOctomapFile), {}},
      {"label-image",
       fromFile("", [](const fs::path& f) { labeled_cloud::readLabelImage(f, classes()); }),
       {}},
      {"points", fromFile("", [](const fs::path& f) { labeled_cloud::readPointFile(f); }), {}},
      {"trajectory",
       fromFile("", [](const fs::path& f) { labeled_cloud::loadTumTrajectory(f); }),
       {}},
      {"classes",
       fromFile("", semantic_types::loadClassTable),
       {"config/classes/synthetic.yaml", "config/classes/semantic_kitti.yaml"}},
      {"weights",
       fromFile("", [](const fs::path& f) { semantic_octree::loadWeights(f, classes()); }),
       {"config/weights/synthetic.yaml"}},
      {"order",
       fromFile("", [](const fs::path& f) { semantic_planning::loadClassOrder(f, classes()); }),
       {"config/orders/synthetic.yaml"}},
      {"vehicle",
       fromFile("", semantic_planning::loadVehicle),
       {"config/vehicles/robot.yaml", "config/vehicles/car.yaml"}},
      {"network",
       fromFile("", [](const fs::path& f) { labeled_cloud::loadNetworkOptions(f, classes()); }),
       {"config/networks/fchardnet_kitti.yaml"}},
      {"confusion",
       fromFile("", [](const fs::path& f) { labeled_cloud::loadConfusionMatrix(f, classes()); }),
       {}}};
  return all;
}
