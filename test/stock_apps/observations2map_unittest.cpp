#include <labeled_cloud/CObservationLabeledCloud.h>
#include <mrpt_compat/Drawing.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_types/ClassTable.h>

#include "StockApps.h"
#include "VillageFrames.h"

namespace {

class Observations2Map : public StockApps {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_APP("observations2map");
    ASSERT_TRUE(villageFrames(2).saveToFile((folder / "village.simplemap").string()));
    std::filesystem::create_directory(folder / "out");
  }
  CommandRun make() const {
    return run("observations2map config/stock-apps/observations2map.ini village.simplemap out/map",
               Plugin::Preloaded);
  }
};

/** The map that the application makes, made without it. */
semantic_octree::SemanticOcTree expectedMap() {
  semantic_map::CSemanticOctoMap map(
      0.2, semantic_types::loadClassTable(MSO_SOURCE_DIR "/config/classes/synthetic.yaml"));
  map.insertionOptions.scan.maxRange = 30;
  map.insertionOptions.conversion.flyingPixelThreshold = 0.02;
  map.loadFromSimpleMap(villageFrames(2));
  return map.tree();
}

/** Share of the first scan's labels that the map says too, at the places of their points. */
double shareOfLabelsIn(const semantic_octree::SemanticOcTree& map) {
  const auto frames = villageFrames(1);
  const auto cloud =
      frames.begin()->sf->getObservationByClass<labeled_cloud::CObservationLabeledCloud>();
  const auto T_map_sensor = frames.begin()->pose->getMeanVal() + cloud->sensorPose;
  double same = 0, all = 0;
  for (std::size_t i = 0; i < cloud->cloud.size(); ++i) {
    const auto& p = cloud->cloud.points[i];
    const auto at = T_map_sensor.composePoint({p.x(), p.y(), p.z()});
    if (p.norm() > 29 || cloud->cloud.classes[i] == semantic_types::kNoClass) continue;
    ++all;
    same += map.query(at.x, at.y, at.z).likeliestClass == cloud->cloud.classes[i];
  }
  return all > 1000 ? same / all : 0;
}

}  // namespace

TEST_F(Observations2Map, theMapIsThatOfTheLibraryBitForBit) {
  const CommandRun made = make();
  ASSERT_EQ(made.status, 0) << made.output;
  const auto map = mapIn("out");
  ASSERT_TRUE(map) << made.output;
  EXPECT_TRUE(*map == expectedMap());
  EXPECT_GT(map->getNumLeafNodes(), 10000u);
  EXPECT_GT(shareOfLabelsIn(*map), 0.9);
}

TEST_F(Observations2Map, theSceneShowsTheClasses) {
  ASSERT_EQ(make().status, 0);
  mrpt_compat::Scene scene;
  ASSERT_TRUE(
      scene.loadFromFile((folder / "out/map_semantic_map__CSemanticOctoMap_00.3Dscene").string()));
  const auto voxels = scene.getByClass<mrpt_compat::drawing::CSetOfObjects>()
                          ->getByClass<mrpt_compat::drawing::COctoMapVoxels>();
  ASSERT_TRUE(voxels);
  EXPECT_GT(voxels->getVoxelCount(mrpt_compat::drawing::VOXEL_SET_OCCUPIED), 1000u);
}
