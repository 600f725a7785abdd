#include <labeled_cloud/ClassTableFile.h>
#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/system/string_utils.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_map/MrptVersion.h>

#include <ostream>
#include <stdexcept>

// Each name serves as "<name>_count" in .ini files.
MAP_DEFINITION_REGISTER("semantic_map::CSemanticOctoMap,semanticOctoMap",
                        semantic_map::CSemanticOctoMap)

namespace semantic_map {

using mrpt::config::CConfigFileBase;
using semantic_octree::ClassTable;

namespace {

constexpr const char* kCreation = "_creationOpts";
constexpr const char* kInsertion = "_insertOpts";
constexpr const char* kLikelihood = "_likelihoodOpts";
constexpr const char* kAbstraction = "_abstractionOpts";
constexpr const char* kRendering = "_renderOpts";

/** A misspelled section would leave all of its options at their defaults, unnoticed. */
void refuseUnknownSections(const CConfigFileBase& source, const std::string& prefix) {
  std::vector<std::string> sections;
  source.getAllSections(sections);
  for (const std::string& section : sections) {
    if (!mrpt::system::strStartsI(section, prefix + "_")) continue;
    const std::string end = section.substr(prefix.size());
    const auto is = [&end](const char* known) { return mrpt::system::strCmpI(end, known); };
    if (!is(kCreation) && !is(kInsertion) && !is(kLikelihood) && !is(kAbstraction) &&
        !is(kRendering))
      throw std::runtime_error(
          "[" + section + "] unknown section; known are " + prefix +
          "_creationOpts, ..._insertOpts, ..._likelihoodOpts, ..._abstractionOpts, "
          "..._renderOpts");
  }
}

}  // namespace

semantic_octree::ClassTable CSemanticOctoMap::occupancyOnly() {
  ClassTable table;
  table.add("occupied", {90, 120, 170});
  return table;
}

CSemanticOctoMap::TMapDefinition::TMapDefinition() = default;

void CSemanticOctoMap::TMapDefinition::loadFromConfigFile_map_specific(
    const CConfigFileBase& source, const std::string& prefix) {
  refuseUnknownSections(source, prefix);
  creationOpts.loadFromConfigFile(source, prefix + kCreation);
  insertionOpts.loadFromConfigFile(source, prefix + kInsertion);
  likelihoodOpts.loadFromConfigFile(source, prefix + kLikelihood);
  abstractionOpts.loadFromConfigFile(source, prefix + kAbstraction);
  renderOpts.loadFromConfigFile(source, prefix + kRendering);
}

void CSemanticOctoMap::TMapDefinition::saveToConfigFile(CConfigFileBase& target,
                                                        const std::string& prefix) const {
  genericMapParams.saveToConfigFile(target, prefix + kCreation);
  creationOpts.saveToConfigFile(target, prefix + kCreation);
  insertionOpts.saveToConfigFile(target, prefix + kInsertion);
  likelihoodOpts.saveToConfigFile(target, prefix + kLikelihood);
  abstractionOpts.saveToConfigFile(target, prefix + kAbstraction);
  renderOpts.saveToConfigFile(target, prefix + kRendering);
}

void CSemanticOctoMap::TMapDefinition::dumpToTextStream_map_specific(std::ostream& out) const {
  const auto dump = [&out](const char* name, const auto& options) {
    out << "[CSemanticOctoMap" << name << "]\n";
    options.dumpToTextStream(out);
  };
  dump(kCreation, creationOpts);
  dump(kInsertion, insertionOpts);
  dump(kLikelihood, likelihoodOpts);
  dump(kAbstraction, abstractionOpts);
  dump(kRendering, renderOpts);
}

CreatedMap CSemanticOctoMap::internal_CreateFromMapDefinition(
    const mrpt::maps::TMetricMapInitializer& definition) {
  const auto& d = dynamic_cast<const TMapDefinition&>(definition);
  const ClassTable classes = d.creationOpts.classes.empty()
                                 ? occupancyOnly()
                                 : labeled_cloud::loadClassTable(d.creationOpts.classes);
  auto map = std::make_unique<CSemanticOctoMap>(d.creationOpts.resolution, classes,
                                                d.insertionOpts.filter);
  map->insertionOptions = d.insertionOpts;
  map->likelihoodOptions = d.likelihoodOpts;
  map->renderingOptions = d.renderOpts;
  map->setAbstraction(d.abstractionOpts);
  return CreatedMap(map.release());
}

}  // namespace semantic_map
