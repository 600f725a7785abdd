#include "Description.h"

#include <map_operations/MapOperations.h>
#include <strict_files/Words.h>

#include <iomanip>

namespace semantic_map_info {

using nlohmann::ordered_json;
using semantic_octree::FilterParameters;
using semantic_octree::MapContents;
using semantic_octree::SemanticOcTree;
using semantic_types::ClassId;

namespace {

ordered_json parametersJson(const FilterParameters& p) {
  return {{"accuracy", p.accuracy},
          {"labelCorrelation", p.labelCorrelation},
          {"hitProbability", p.hitProbability},
          {"falseAlarmProbability", p.falseAlarmProbability},
          {"minOccupancy", p.minOccupancy},
          {"maxProbability", p.maxProbability},
          {"softLabelFloor", p.softLabelFloor},
          {"calibration", {{"power", p.calibration.power}, {"shared", p.calibration.shared}}}};
}

void addHalfLife(const SemanticOcTree& map, ClassId id, ordered_json& description) {
  const double seconds = map.classes().halfLife(id);
  if (seconds != semantic_types::kForever) description["halfLife"] = seconds;
}

ordered_json boxJson(const MapContents& contents) {
  if (contents.box.isEmpty()) return nullptr;
  const Eigen::Vector3d low = contents.box.min(), high = contents.box.max();
  return {{"min", {low.x(), low.y(), low.z()}}, {"max", {high.x(), high.y(), high.z()}}};
}

ordered_json classesJson(const SemanticOcTree& map, const MapContents& contents) {
  ordered_json classes = ordered_json::array();
  for (int id = 1; id <= map.numClasses(); ++id) {
    const auto& table = map.classes();
    const auto& color = table.color(static_cast<ClassId>(id));
    classes.push_back({{"id", id},
                       {"name", table.name(static_cast<ClassId>(id))},
                       {"color", {color.r, color.g, color.b}},
                       {"voxels", contents.voxelsOfClass[id]}});
    addHalfLife(map, static_cast<ClassId>(id), classes.back());
  }
  return classes;
}

ordered_json folderJson(const semantic_octree::MapFolder::Contents& folder,
                        const semantic_octree::MapFolder::Others& others) {
  return {{"tiles", folder.tiles},           {"tileSize", folder.tileSize},
          {"generation", folder.generation}, {"bytes", folder.bytesOnDisk},
          {"otherFiles", others.files},      {"otherBytes", others.bytes}};
}

void printBox(const ordered_json& box, std::ostream& out) {
  if (box.is_null()) {
    out << "nothing is known yet\n";
    return;
  }
  for (int axis = 0; axis < 3; ++axis)
    out << (axis ? ", " : "") << "xyz"[axis] << " " << box["min"][axis].get<double>() << " to "
        << box["max"][axis].get<double>();
  out << " m\n";
}

void printFolder(const ordered_json& folder, std::ostream& out) {
  out << "\n  folder        " << folder["tiles"] << " tiles of " << folder["tileSize"] << " m, "
      << strict_files::sizeText(folder["bytes"]) << ", saved " << folder["generation"] << " times";
  if (folder["otherFiles"] > 0)
    out << "\n  not of it     " << folder["otherFiles"] << " files, "
        << strict_files::sizeText(folder["otherBytes"])
        << ", that index.yaml does not name: of a process that writes, was killed, or others";
}

void printTime(const ordered_json& d, std::ostream& out) {
  const char* before = "";
  const auto say = [&](const std::string& name, const ordered_json& of) {
    if (!of.contains("halfLife")) return;
    out << before << name << " " << of["halfLife"] << " s";
    before = ", ";
  };
  out << "\n  clock         " << d["clock"] << " s\n  half-lives    ";
  for (const auto& c : d["classes"]) say(c["name"], c);
  say("free space", d["freeSpace"]);
}

}  // namespace

ordered_json describe(semantic_octree::StoredMap& stored, const std::filesystem::path& path) {
  const SemanticOcTree& map = stored.tree();
  const MapContents contents = contentsOf(map);
  ordered_json description = {{"resolution", map.getResolution()},
                              {"nodes", map.size()},
                              {"leaves", contents.leaves},
                              {"innerNodes", contents.innerNodes},
                              {"bytes", contents.bytes},
                              {"boundingBox", boxJson(contents)},
                              {"freeVoxels", contents.freeVoxels},
                              {"occupiedVoxels", contents.occupiedVoxels},
                              {"occupiedWithoutClass", contents.voxelsOfClass[0]},
                              {"filter", parametersJson(map.filterParameters())},
                              {"classes", classesJson(map, contents)}};
  if (map.classes().hasHalfLives()) {
    description["clock"] = map.clock();
    description["freeSpace"] = ordered_json::object();
    addHalfLife(map, semantic_types::kNoClass, description["freeSpace"]);
  }
  if (stored.folder())
    description["folder"] =
        folderJson(stored.folder()->contents(), semantic_octree::MapFolder::othersAt(path));
  return description;
}

void printText(const std::string& name, const ordered_json& d, std::ostream& out) {
  out << name << "\n"
      << "  resolution    " << d["resolution"] << " m\n"
      << "  known space   ";
  printBox(d["boundingBox"], out);
  out << "  nodes         " << d["nodes"] << " (" << d["leaves"] << " leaves, " << d["innerNodes"]
      << " inner nodes)\n"
      << "  memory        " << strict_files::sizeText(d["bytes"]) << "\n"
      << "  voxels        " << d["occupiedVoxels"] << " occupied, " << d["freeVoxels"] << " free\n"
      << "  filter       ";
  for (const auto& [key, value] : d["filter"].items())
    if (!value.is_object())
      out << " " << key << " " << (value.is_string() ? value.get<std::string>() : value.dump());
  const ordered_json& calibration = d["filter"]["calibration"];
  out << "\n  stated        beliefs to the power of " << calibration["power"] << ", "
      << 100 * calibration["shared"].get<double>()
      << " % shared by the classes of a voxel's record";
  if (d.contains("folder")) printFolder(d["folder"], out);
  if (d.contains("clock")) printTime(d, out);
  out << "\n  occupied voxels by likeliest class (of " << d["classes"].size() << " classes)\n";
  const auto line = [&out](const std::string& id, const ordered_json& voxels,
                           const std::string& label) {
    out << std::setw(7) << id << " " << std::setw(10) << voxels << "  " << label << "\n";
  };
  for (const auto& c : d["classes"])
    if (c["voxels"] > 0) line(c["id"].dump(), c["voxels"], c["name"]);
  if (d["occupiedWithoutClass"] > 0) line("-", d["occupiedWithoutClass"], "(no class was seen)");
}

}  // namespace semantic_map_info
