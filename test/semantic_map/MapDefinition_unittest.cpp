#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt_compat/Release.h>

#include "SmallMaps.h"
#include "TemporaryFolder.h"

using mrpt::maps::CMultiMetricMap;
using mrpt::maps::TSetOfMetricMapInitializers;
using semantic_map::CSemanticOctoMap;
using semantic_map::TRenderingOptions;
using semantic_octree::InsertionOptions;

namespace {

CSemanticOctoMap::Ptr mapOf(const std::string& ini) {
  TSetOfMetricMapInitializers definitions;
  definitions.loadFromConfigFile(mrpt::config::CConfigFileMemory(ini), "Maps");
  CMultiMetricMap maps(definitions);
  return maps.mapByClass<CSemanticOctoMap>();
}

/** One map with a line in one of its sections. */
std::string withLine(const std::string& section, const std::string& line) {
  return "[Maps]\nsemanticOctoMap_count = 1\n[Maps_semanticOctoMap_00_" + section + "]\n" + line +
         "\n";
}

void expectRefused(const std::string& section, const std::string& line,
                   const std::vector<std::string>& parts) {
  const std::string error = errorOf([&] { mapOf(withLine(section, line)); });
  for (const std::string& part : parts)
    EXPECT_TRUE(contains(error, part)) << "'" << error << "' lacks '" << part << "'";
}

const char* const kClasses =
    "classes:\n  - {id: 1, name: road, color: [200, 30, 30]}\n"
    "  - {id: 2, name: tree, color: [30, 180, 60]}\n";

}  // namespace

TEST(MapDefinition, bothNamesMakeTheMap) {
  EXPECT_TRUE(mapOf("[Maps]\nsemanticOctoMap_count = 1\n"));
  EXPECT_TRUE(mapOf("[Maps]\nsemantic_map::CSemanticOctoMap_count = 1\n"));
  EXPECT_FALSE(mapOf("[Maps]\npointsMap_count = 1\n"));
}

TEST(MapDefinition, optionsAreReadFromTheirSections) {
  const TemporaryFolder folder;
  const auto classes = folder.write("classes.yaml", kClasses);
  const auto map = mapOf(
      "[Maps]\nsemanticOctoMap_count = 1\n"
      "[Maps_semanticOctoMap_00_creationOpts]\nresolution = 0.25 // m\nclasses = " +
      classes.string() +
      "\nenableSaveAs3DObject = false\n"
      "[Maps_semanticOctoMap_00_insertOpts]\nrays = EndVoxels\nmaxRange = 30\n"
      "decimation = 3\naccuracy = 0.8\n"
      "[Maps_semanticOctoMap_00_likelihoodOpts]\ndecimation = 7\n"
      "[Maps_semanticOctoMap_00_renderOpts]\ncoloring = entropy\nmax_height = inf\n");
  const auto& insertion = map->insertionOptions;
  EXPECT_EQ(map->tree().getResolution(), 0.25);
  EXPECT_EQ(map->tree().classes().name(2), "tree");
  EXPECT_FALSE(map->genericMapParams.enableSaveAs3DObject);
  // Names are read however their words are parted.
  EXPECT_EQ(insertion.scan.rays, InsertionOptions::Rays::EndVoxels);
  EXPECT_EQ(insertion.scan.maxRange, 30);
  EXPECT_EQ(insertion.conversion.decimation, 3);
  EXPECT_EQ(map->tree().filterParameters().accuracy, 0.8);
  EXPECT_EQ(map->likelihoodOptions.decimation, 7);
  EXPECT_EQ(map->renderingOptions.coloring, TRenderingOptions::Coloring::Entropy);
  EXPECT_EQ(map->renderingOptions.maxHeight, INFINITY);
}

TEST(MapDefinition, anUnknownKeyOrSectionIsNamedWithTheNearestKnownOne) {
  expectRefused(
      "creationOpts", "resolutoin = 0.1",
      {"Maps_semanticOctoMap_00_creationOpts", "'resolutoin'", "did you mean 'resolution'?"});
  expectRefused("insertOpts", "maxrage = 3", {"_insertOpts", "'maxrage'", "'max_range'?"});
  expectRefused("likelihoodOpts", "foo = 3", {"_likelihoodOpts", "'foo'"});
  expectRefused("renderOpts", "decimation = 3", {"_renderOpts", "'decimation'"});
  expectRefused("insertionOpts", "max_range = 3",
                {"Maps_semanticOctoMap_00_insertionOpts", "unknown section", "insertOpts"});
}

TEST(MapDefinition, whatMrptLeavesOutInSilenceIsNamed) {
  const auto refusal = [](const std::string& lines) {
    return errorOf([&] { mapOf("[Maps]\nsemanticOctoMap_count = 1\n" + lines); });
  };
  const std::string unknown = refusal("pointMap_count = 1\n");
  EXPECT_TRUE(contains(unknown, "pointMap_count: there is no map type"));
  EXPECT_EQ(refusal("pointsMap_count = 1\nother = 3\n"), "");
  // MRPT itself refuses even none of what it does not know, since 2.11.3.
  EXPECT_EQ(refusal("pointMap_count = 0\n").empty(), !MSO_MRPT_AT_LEAST(2, 11, 3));
  const std::string beyond = refusal("[Maps_semanticOctoMap_01_insertOpts]\nmax_range = 3\n");
  EXPECT_TRUE(contains(beyond, "Maps_semanticOctoMap_01_insertOpts") && contains(beyond, "is 1"))
      << beyond;
  EXPECT_TRUE(contains(refusal("[Maps_semanticOctoMap_0_insertOpts]\n"), "begin at 00"));
  EXPECT_EQ(refusal("[Maps_pointsMap_07_insertOpts]\n[Other_semanticOctoMap_05_insertOpts]\n"), "");
  EXPECT_TRUE(contains(errorOf([] {
                         mapOf(
                             "[Maps]\nsemantic_map::CSemanticOctoMap_count = 1\n"
                             "[Maps_semantic_map::CSemanticOctoMap_1_insertOpts]\n");
                       }),
                       "begin at 00"));
}

TEST(MapDefinition, aBadValueIsNamedWithWhatWasExpected) {
  expectRefused("creationOpts", "resolution = wide", {"creationOpts", "resolution", "'wide'"});
  expectRefused("creationOpts", "resolution = 0", {"creationOpts", "resolution", "0"});
  expectRefused("insertOpts", "rays = some", {"rays", "'some'", "one of all, end_voxels"});
  expectRefused("insertOpts", "accuracy = 1.5", {"accuracy", "1.5"});
  expectRefused("likelihoodOpts", "point_weight = 0", {"point_weight", "0"});
  expectRefused("creationOpts", "classes = no/such.yaml", {"no/such.yaml"});
  expectRefused("renderOpts", "min_height = 5\nmax_height = 2", {"min_height", "5", "max_height"});
}

TEST(MapDefinition, whatIsSavedIsReadBack) {
  CSemanticOctoMap::TMapDefinition definition, read;
  definition.creationOpts.resolution = 0.1 + 0.2;  // not a short decimal
  definition.insertionOpts.scan.maxRange = 1.0 / 3;
  definition.insertionOpts.filter.accuracy = 0.7;
  definition.likelihoodOpts.useLabels = false;
  definition.renderOpts.coloring = TRenderingOptions::Coloring::Probability;
  definition.genericMapParams.enableObservationLikelihood = false;
  mrpt::config::CConfigFileMemory file;
  definition.saveToConfigFile(file, "M");
  read.loadFromConfigFile(mrpt::config::CConfigFileMemory(file.getContent()), "M");
  EXPECT_EQ(read.creationOpts.resolution, 0.1 + 0.2);
  EXPECT_EQ(read.insertionOpts.scan.maxRange, 1.0 / 3);
  EXPECT_TRUE(read.insertionOpts.filter == definition.insertionOpts.filter);
  EXPECT_FALSE(read.likelihoodOpts.useLabels);
  EXPECT_EQ(read.renderOpts.coloring, TRenderingOptions::Coloring::Probability);
  EXPECT_EQ(read.renderOpts.maxHeight, INFINITY);
  EXPECT_FALSE(read.genericMapParams.enableObservationLikelihood);
}

TEST(MapOptions, aRefusedSectionLeavesTheOptionsAsTheyWere) {
  semantic_map::TInsertionOptions options;
  options.scan.maxRange = 12;
  const mrpt::config::CConfigFileMemory file("[S]\nmax_range = 5\ndecimation = 0\n");
  EXPECT_THROW(options.loadFromConfigFile(file, "S"), std::runtime_error);
  EXPECT_EQ(options.scan.maxRange, 12);
}
