// config/mola, read as mp2p_icp reads it: nothing of MOLA is needed.
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/containers/yaml.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/serialization/CArchive.h>
#include <semantic_types/ClassTable.h>

#include <filesystem>
#include <string>

#include "SmallMaps.h"

namespace {

using mrpt::containers::yaml;
using mrpt::maps::CMultiMetricMap;
using semantic_map::CSemanticOctoMap;

/** A generator's `metric_map_definition` as sections of an .ini file, and the map of these. */
CMultiMetricMap::Ptr mapOf(const yaml& definition) {
  const std::string prefix = "map", name = definition["class"].as<std::string>();
  mrpt::config::CConfigFileMemory config;
  config.write(prefix, name + "_count", "1");
  for (const auto& [key, value] : definition.asMap()) {
    if (!value.isMap()) continue;
    for (const auto& [option, text] : value.asMap())
      config.write(prefix + "_" + name + "_00_" + key.as<std::string>(), option.as<std::string>(),
                   text.as<std::string>());
  }
  mrpt::maps::TSetOfMetricMapInitializers initializers;
  initializers.loadFromConfigFile(config, prefix);
  auto maps = CMultiMetricMap::Create();
  maps->setListOfMaps(initializers);
  return maps;
}

}  // namespace

TEST(Mola, pipelineMakesASemanticLayerThatIsSavedAndHasPoints) {
  const std::filesystem::path sources = MSO_SOURCE_DIR;
  yaml pipeline = yaml::FromFile((sources / "config/mola/semantic-map.yaml").string());
  yaml definition = pipeline["generators"].asSequence().at(0).asMap().at("params").asMap().at(
      "metric_map_definition");
  const auto classes = sources / definition["creationOpts"]["classes"].as<std::string>();
  definition["creationOpts"]["classes"] = classes.string();
  const auto maps = mapOf(definition);
  ASSERT_EQ(maps->maps.size(), 1u);
  const mrpt::maps::CMetricMap::Ptr layer = maps->maps[0];
  auto* map = dynamic_cast<CSemanticOctoMap*>(layer.get());
  ASSERT_NE(map, nullptr);

  labeled_cloud::CObservationLabeledCloud observation;
  observation.timestamp = mrpt::Clock::fromDouble(1);
  observation.classNames = {semantic_types::loadClassTable(classes).name(1)};
  for (int i = 0; i < 20; ++i) {
    observation.cloud.points.emplace_back(3, 0.2f * float(i), 0);
    observation.cloud.classes.push_back(1);
  }
  const mrpt::poses::CPose3D T_map_robot(1, 0, 0, 0, 0, 0);
  for (int scan = 0; scan < 3; ++scan) observation.insertObservationInto(*layer, T_map_robot);
  EXPECT_EQ(map->tree().query(4.1, 1.1, 0.1).likeliestClass, 1);

  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << *layer;
  stream.Seek(0);
  const auto read = archive.ReadObject<mrpt::maps::CMetricMap>();
  EXPECT_TRUE(dynamic_cast<const CSemanticOctoMap&>(*read).tree() == map->tree());
  ASSERT_NE(read->getAsSimplePointsMap(), nullptr);
  EXPECT_EQ(read->getAsSimplePointsMap()->size(), layer->getAsSimplePointsMap()->size());
}
