#include "Readers.h"

#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/LabelFolder.h>
#include <labeled_cloud/LabelModel.h>
#include <labeled_cloud/NetworkLabeler.h>
#include <labeled_cloud/PointFile.h>
#include <labeled_cloud/RawlogReader.h>
#include <labeled_cloud/ScanConverter.h>
#include <labeled_cloud/Trajectory.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <octomap/OcTree.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_map/ImportOctomap.h>
#include <semantic_octree/MapFolder.h>
#include <semantic_octree/OctomapConversion.h>
#include <semantic_octree/TreeFile.h>
#include <semantic_octree/WeightsFile.h>
#include <semantic_planning/planner/OrderFile.h>
#include <semantic_planning/vehicle/VehicleFile.h>
#include <semantic_types/ClassTableFile.h>

#include <sstream>

#include "FuzzedFile.h"

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

void readMap(const std::string& bytes) {
  std::istringstream in(bytes);
  const semantic_octree::SemanticOcTree map = semantic_octree::readTree(in);
  std::ostringstream out;
  semantic_octree::writeTree(out, map);
  std::istringstream again(out.str());
  if (!(semantic_octree::readTree(again) == map)) std::abort();
}

/** The leaves' file, which it names, is not there. */
void readTileIndex(const std::string& bytes) {
  const fs::path folder =
      fs::temp_directory_path() / ("mso_fuzz_tiles_" + std::to_string(getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "index.yaml", std::ios::binary) << bytes;
  try {
    semantic_octree::MapFolder::emptyMap(folder);
  } catch (...) {
    fs::remove_all(folder);
    throw;
  }
}

void readOctomap(const fs::path& file) {
  const auto tree = semantic_map::readOctomapFile(file);
  if (tree->size() > 0) semantic_octree::fromOcTree(*tree, classes());
}

/** From an MRPT archive, and what was taken back into one. */
template <class Object>
void readArchive(const std::string& bytes) {
  semantic_map::registerMaps();  // built by clang, they were met without a name when their library
                                 // was loaded
  Object object;
  mrpt::io::CMemoryStream in, out;
  in.assignMemoryNotOwn(bytes.data(), bytes.size());
  mrpt::serialization::archiveFrom(in).ReadObject(&object);
  mrpt::serialization::archiveFrom(out) << object;
}

/** Not through MRPT's TSetOfMetricMapInitializers, which leaks what throws. */
void readDefinition(const std::string& bytes) {
  semantic_map::CSemanticOctoMap::TMapDefinition definition;
  definition.loadFromConfigFile(mrpt::config::CConfigFileMemory(bytes), "Maps_semanticOctoMap_00");
}

void readLabels(const fs::path& file) {
  labeled_cloud::LabelImage image = labeled_cloud::readLabelImage(file, classes());
  labeled_cloud::readConfidences(file, image);
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

std::vector<Reader> libraryReaders() {
  return {
      {"map", readMap, {}},
      {"tile-index", readTileIndex, {}},
      {"rawlog", fromFile(".rawlog", readRawlog), {}},
      {"octomap", fromFile(".ot", readOctomap), {}},
      {"octomap-binary", fromFile(".bt", readOctomap), {}},
      {"archived-map", readArchive<semantic_map::CSemanticOctoMap>, {}},
      {"archived-cloud", readArchive<labeled_cloud::CObservationLabeledCloud>, {}},
      {"map-definition", readDefinition, {}},
      {"label-image", fromFile("", readLabels), {}},
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
}

const std::vector<Reader>& readers() {
  static const std::vector<Reader> all = [] {
    std::vector<Reader> both = libraryReaders();
    for (Reader& reader : programReaders()) both.push_back(std::move(reader));
    return both;
  }();
  return all;
}
