#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/system/string_utils.h>
#include <mrpt_compat/Maps.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_types/ClassTable.h>
#include <strict_files/IniSection.h>

#include <ostream>

// Each name serves as "<name>_count" in .ini files.
MAP_DEFINITION_REGISTER("semantic_map::CSemanticOctoMap,semanticOctoMap",
                        semantic_map::CSemanticOctoMap)

namespace semantic_map {

using mrpt::config::CConfigFileBase;
using semantic_types::ClassTable;

namespace {

/** Calls use(end of the section's name, options in it) for each section of a map. */
template <class Definition, class F>
void forEachSection(Definition& map, const F& use) {
  use("_creationOpts", map.creationOpts);
  use("_folderOpts", map.folderOpts);
  use("_insertOpts", map.insertionOpts);
  use("_likelihoodOpts", map.likelihoodOpts);
  use("_abstractionOpts", map.abstractionOpts);
  use("_renderOpts", map.renderOpts);
}

}  // namespace

semantic_types::ClassTable CSemanticOctoMap::occupancyOnly() {
  ClassTable table;
  table.add("occupied", {90, 120, 170});
  return table;
}

CSemanticOctoMap::TMapDefinition::TMapDefinition() = default;

void CSemanticOctoMap::TMapDefinition::loadFromConfigFile_map_specific(
    const CConfigFileBase& source, const std::string& prefix) {
  std::vector<std::string> sections, known;
  forEachSection(*this, [&](const char* end, const auto&) { known.push_back(prefix + end); });
  source.getAllSections(sections);
  // A misspelled section would leave all of its options at their defaults, unnoticed.
  for (const std::string& section : sections)
    if (mrpt::system::strStartsI(section, prefix + "_")) strict_files::checkSection(section, known);
  forEachSection(*this, [&](const char* end, auto& options) {
    options.loadFromConfigFile(source, prefix + end);
  });
}

void CSemanticOctoMap::TMapDefinition::saveToConfigFile(CConfigFileBase& target,
                                                        const std::string& prefix) const {
  genericMapParams.saveToConfigFile(target, prefix + "_creationOpts");
  forEachSection(*this, [&](const char* end, const auto& options) {
    options.saveToConfigFile(target, prefix + end);
  });
}

void CSemanticOctoMap::TMapDefinition::dumpToTextStream_map_specific(std::ostream& out) const {
  forEachSection(*this, [&out](const char* end, const auto& options) {
    out << "[CSemanticOctoMap" << end << "]\n";
    options.dumpToTextStream(out);
  });
}

mrpt_compat::CreatedMap CSemanticOctoMap::internal_CreateFromMapDefinition(
    const mrpt::maps::TMetricMapInitializer& definition) {
  const auto& d = dynamic_cast<const TMapDefinition&>(definition);
  const ClassTable classes = d.creationOpts.classes.empty()
                                 ? occupancyOnly()
                                 : semantic_types::loadClassTable(d.creationOpts.classes);
  auto map = std::make_unique<CSemanticOctoMap>(d.creationOpts.resolution, classes,
                                                d.insertionOpts.filter);
  map->insertionOptions = d.insertionOpts;
  map->likelihoodOptions = d.likelihoodOpts;
  map->renderingOptions = d.renderOpts;
  if (!d.folderOpts.folder.empty()) map->openFolder(d.folderOpts);
  map->setAbstraction(d.abstractionOpts);
  return mrpt_compat::CreatedMap(map.release());
}

}  // namespace semantic_map
