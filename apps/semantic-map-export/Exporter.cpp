#include "Exporter.h"

#include <map_operations/MapOperations.h>
#include <map_pictures/MapPictures.h>
#include <mrpt_compat/Drawing.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_map/MapFiles.h>
#include <semantic_planning/planner/OrderFile.h>

#include <fstream>
#include <stdexcept>

namespace semantic_map_export {

namespace fs = std::filesystem;

struct Exporter::Format {
  const char* ending;
  const char* description;
  std::function<void(Exporter&, const fs::path&)> write;
  const char* beside = nullptr;  ///< ending of a second file
};

const std::vector<Exporter::Format>& Exporter::allFormats() {
  static const std::vector<Format> formats = {
      {".ot", "OctoMap's tree, with colors of classes", &Exporter::writeOctree},
      {".bt", "OctoMap's binary tree",
       [](Exporter& e, const fs::path& file) {
         e.stage(file, [&e](std::ostream& out) { writeBinaryOcTree(out, e.m_map); });
       }},
      {".ply", "points with class, probability and color",
       [](Exporter& e, const fs::path& file) {
         e.stage(file, [&e](std::ostream& out) {
           semantic_map::writePly(out, e.m_map, e.m_options.points);
         });
       }},
      {".csv", "the same as a table",
       [](Exporter& e, const fs::path& file) {
         e.stage(file, [&e](std::ostream& out) {
           semantic_map::writeCsv(out, e.m_map, e.m_options.points);
         });
       }},
      {".gridmap", "MRPT's 2D occupancy grid",
       [](Exporter& e, const fs::path& file) {
         e.stage(file, [&e](std::ostream& out) {
           semantic_map::writeGridMap(out, semantic_map::gridOf(e.m_map, e.m_options.grid));
         });
       }},
      {".yaml", "the same for ROS's map_server, with its picture beside", &Exporter::writeMapServer,
       ".png"},
      {".png", "classes from above, with a world file (.pgw) beside", &Exporter::writeClassMap,
       ".pgw"},
      {".3Dscene", "MRPT's scene", &Exporter::writeScene}};
  return formats;
}

std::string Exporter::formats() {
  std::string text;
  for (const Format& format : allFormats())
    text += std::string(text.empty() ? "" : "; ") + format.ending + ": " + format.description;
  return text;
}

const Exporter::Format& Exporter::formatOf(const fs::path& file) {
  std::string endings;
  for (const Format& format : allFormats()) {
    if (file.extension() == format.ending) return format;
    endings += std::string(" ") + format.ending;
  }
  throw std::runtime_error(file.string() + ": the ending says no format, expected one of" +
                           endings);
}

std::vector<fs::path> Exporter::filesOf(const fs::path& file, const ExportOptions& options) {
  std::vector<fs::path> files = {file};
  const char* beside = formatOf(file).beside;
  if (file.extension() == ".yaml" && !options.costs.order.empty())
    beside = endingOf(options.costs.mode);
  if (beside) files.push_back(fs::path(file).replace_extension(beside));
  return files;
}

void Exporter::write(const fs::path& file) {
  try {
    formatOf(file).write(*this, file);
  } catch (const std::exception& e) {
    const std::string message = e.what();
    const bool named = message.find(file.stem().string() + ".") != std::string::npos;
    throw std::runtime_error(named ? message : file.string() + ": " + message);
  }
}

std::vector<fs::path> Exporter::commit() {
  std::vector<fs::path> files;
  for (Staged& staged : m_staged) {
    staged.file.commit();
    files.push_back(staged.target);
  }
  m_staged.clear();
  return files;
}

void Exporter::stageFile(const fs::path& file, const Filler& fill) {
  fill(m_staged.emplace_back(file.lexically_normal()).file.path());
}

void Exporter::stage(const fs::path& file, const Writer& writer) {
  stageFile(file, [&](const fs::path& staged) {
    std::ofstream out(staged, std::ios::binary);
    writer(out);
    out.close();
    if (!out) throw std::runtime_error(file.string() + ": cannot be written");
  });
}

void Exporter::writeOctree(const fs::path& file) {
  stage(file, [this](std::ostream& out) {
    m_options.colors ? writeColorOcTree(out, m_map) : writeOcTree(out, m_map);
  });
}

void Exporter::writeClassMap(const fs::path& file) {
  const auto drawn = map_pictures::drawClassMap(m_map, m_options.maxHeight);
  stageFile(file,
            [&drawn](const fs::path& staged) { map_pictures::savePicture(drawn.picture, staged); });
  stage(fs::path(file).replace_extension(".pgw"),
        [&drawn](std::ostream& out) { out << drawn.worldFile; });
}

void Exporter::writeCosts(const fs::path& file) {
  const CostOptions& costs = m_options.costs;
  const auto order = semantic_planning::loadClassOrder(costs.order, m_map.classes());
  const auto vehicle = costs.vehicle.empty() ? semantic_planning::VehicleOptions()
                                             : semantic_planning::loadVehicle(costs.vehicle);
  const fs::path picture = fs::path(file).replace_extension(endingOf(costs.mode));
  const CostFiles files = semantic_map_export::filesOf(costGridOf(m_map, order, vehicle),
                                                       costs.mode, picture.filename().string());
  stage(file, [&files](std::ostream& out) { out << files.yaml; });
  stage(picture, [&files](std::ostream& out) { out << files.picture; });
}

void Exporter::writeMapServer(const fs::path& file) {
  if (!m_options.costs.order.empty()) return writeCosts(file);
  const fs::path picture = fs::path(file).replace_extension(".png");
  const auto files = semantic_map::mapServerFiles(semantic_map::gridOf(m_map, m_options.grid),
                                                  picture.filename().string());
  stage(file, [&files](std::ostream& out) { out << files.yaml; });
  stage(picture, [&files](std::ostream& out) { out << files.png; });
}

void Exporter::writeScene(const fs::path& file) {
  semantic_octree::SemanticOcTree copy = semantic_octree::emptyLike(m_map);
  copyTo(copy, m_map);
  semantic_map::CSemanticOctoMap map(std::move(copy));
  if (m_options.maxHeight) map.renderingOptions.maxHeight = *m_options.maxHeight;
  const auto objects = mrpt_compat::drawing::CSetOfObjects::Create();
  map.getVisualizationInto(*objects);
  mrpt_compat::Scene scene;
  scene.insert(objects);
  stageFile(file, [&scene](const fs::path& staged) { semantic_map::writeScene(scene, staged); });
}

}  // namespace semantic_map_export
