#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/core/format.h>
#include <mrpt/maps/TMetricMapTypesRegistry.h>
#include <mrpt/system/string_utils.h>
#include <mrpt_compat/Maps.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_types/ClassTable.h>
#include <strict_files/IniSection.h>

#include <algorithm>
#include <ostream>
#include <stdexcept>

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

/** "Maps_semanticOctoMap_00" in its parts; empty if it is not made so, as MRPT makes it. */
struct PrefixParts {
  std::string section, map;
};

PrefixParts partsOf(const std::string& prefix) {
  for (const std::string name :
       {"semantic_map::CSemanticOctoMap", "CSemanticOctoMap", "semanticOctoMap"}) {
    const std::size_t place = prefix.rfind("_" + name + "_");
    if (place != std::string::npos) return {prefix.substr(0, place), name};
  }
  return {};
}

/** MRPT 2.5.8 leaves out maps of which it knows no type by that name, in silence. */
void refuseUnknownMaps(const CConfigFileBase& source, const std::string& section) {
  const auto known = mrpt::maps::internal::TMetricMapTypesRegistry::Instance().getAllRegistered();
  std::vector<std::string> keys;
  source.getAllKeys(section, keys);
  for (const std::string& key : keys) {
    const std::size_t end = key.rfind("_count");
    if (end == std::string::npos || end + 6 != key.size()) continue;
    const auto same = [&](const auto& type) {
      return mrpt::system::strCmpI(type.first, key.substr(0, end));
    };
    if (std::any_of(known.begin(), known.end(), same) || source.read_int(section, key, 0) == 0)
      continue;
    throw std::runtime_error("[" + section + "] " + key + ": there is no map type of this name");
  }
}

/** Sections of a map beyond the count, or with another number than of two digits. */
void refuseUnknownNumbers(const CConfigFileBase& source, const PrefixParts& parts) {
  const std::string base = parts.section + "_" + parts.map + "_";
  const int count = source.read_int(parts.section, parts.map + "_count", 0);
  std::vector<std::string> sections;
  source.getAllSections(sections);
  for (const std::string& section : sections) {
    if (!mrpt::system::strStartsI(section, base)) continue;
    const std::string number =
        section.substr(base.size(), section.find('_', base.size()) - base.size());
    bool known = false;
    for (int i = 0; i < count; ++i) known = known || number == mrpt::format("%02i", i);
    if (!known)
      throw std::runtime_error("[" + section + "] no map has this section: " + parts.map +
                               "_count is " + std::to_string(count) + ", numbers begin at 00");
  }
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
  if (const PrefixParts parts = partsOf(prefix); !parts.map.empty()) {
    refuseUnknownMaps(source, parts.section);
    refuseUnknownNumbers(source, parts);
  }
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
