#include "Readers.h"

#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/LabelImage.h>
#include <labeled_cloud/LabelModel.h>
#include <labeled_cloud/NetworkLabeler.h>
#include <labeled_cloud/PointFile.h>
#include <labeled_cloud/Rawlogs.h>
#include <labeled_cloud/ScanConverter.h>
#include <labeled_cloud/Trajectory.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_map/MapFiles.h>
#include <semantic_planning/planner/OrderFile.h>
#include <semantic_planning/vehicle/VehicleOptions.h>
#include <semantic_types/ClassTable.h>

#include "FuzzedFile.h"

namespace {

namespace fs = std::filesystem;
using semantic_types::ClassTable;

void readOctomap(const fs::path& file) {
  semantic_map::importOctomapFile(file);
  const semantic_octree::SemanticOcTree like(0.1, fuzzedClasses());
  semantic_map::importOctomapFile(file, &like);
}

/** From an MRPT archive, and what was taken back into one. */
template <class Object>
void readArchive(const std::string& bytes) {
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

void readLabels(const fs::path& file, const ClassTable& classes) {
  labeled_cloud::LabelImage image = labeled_cloud::readLabelImage(file, classes);
  labeled_cloud::readConfidences(file, image);
}

void readRawlog(const fs::path& file) {
  labeled_cloud::RawlogReader reader(file);
  labeled_cloud::ScanConverter converter(fuzzedClasses());
  semantic_octree::InsertionOptions options;
  options.maxScanMemory = 100;
  while (const auto entry = reader.next())
    for (const auto& observation : entry->observations) try {
        const auto scan = converter.convert(*observation);
        if (!scan) continue;
        semantic_octree::SemanticOcTree map(1, fuzzedClasses());
        map.insert(scan->cloud, Eigen::Isometry3d::Identity(), options);
      } catch (const std::exception&) {
        continue;
      }
}

}  // namespace

const ClassTable& fuzzedClasses() {
  static const ClassTable table = [] {
    ClassTable t;
    for (const char* name : {"road", "grass", "building", "tree"}) t.add(name, {});
    return t;
  }();
  return table;
}

std::vector<Reader> libraryReaders() {
  const auto classesOf = [](const char* name) {
    return semantic_types::loadClassTable(fs::path(MSO_SOURCES "/config/classes") / name);
  };
  static const ClassTable synthetic = classesOf("synthetic.yaml"),
                          kitti = classesOf("semantic_kitti.yaml");
  return {
      {"rawlog", fromFile(".rawlog", readRawlog), {}},
      {"octomap", fromFile(".ot", readOctomap), {}},
      {"octomap-binary", fromFile(".bt", readOctomap), {}},
      {"archived-map", readArchive<semantic_map::CSemanticOctoMap>, {}},
      {"archived-cloud", readArchive<labeled_cloud::CObservationLabeledCloud>, {}},
      {"map-definition", readDefinition, {}},
      {"label-image", fromFile("", [](const fs::path& f) { readLabels(f, kitti); }), {}},
      {"points", fromFile("", [](const fs::path& f) { labeled_cloud::readPointFile(f); }), {}},
      {"trajectory",
       fromFile("", [](const fs::path& f) { labeled_cloud::loadTumTrajectory(f); }),
       {}},
      {"classes",
       fromFile("", semantic_types::loadClassTable),
       {"config/classes/synthetic.yaml", "config/classes/semantic_kitti.yaml"}},
      {"weights",
       fromFile("", [](const fs::path& f) { semantic_octree::loadWeights(f, synthetic); }),
       {"config/weights/synthetic.yaml"}},
      {"order",
       fromFile("", [](const fs::path& f) { semantic_planning::loadClassOrder(f, synthetic); }),
       {"config/orders/synthetic.yaml"}},
      {"vehicle",
       fromFile("", semantic_planning::loadVehicle),
       {"config/vehicles/robot.yaml", "config/vehicles/car.yaml"}},
      {"network",
       fromFile("", [](const fs::path& f) { labeled_cloud::loadNetworkOptions(f, kitti); }),
       {"config/networks/fchardnet_kitti.yaml"}},
      {"confusion",
       fromFile("",
                [](const fs::path& f) { labeled_cloud::loadConfusionMatrix(f, fuzzedClasses()); }),
       {}}};
}

const std::vector<Reader>& readers() {
  static const std::vector<Reader> all = [] {
    std::vector<Reader> readers = libraryReaders();
    for (const auto& more : {mapReaders(), programReaders()})
      readers.insert(readers.end(), more.begin(), more.end());
    return readers;
  }();
  return all;
}
