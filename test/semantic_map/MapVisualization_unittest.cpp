#include <gtest/gtest.h>
#include <mrpt_compat/Drawing.h>
#include <semantic_octree/TreeFile.h>

#include <cmath>

#include "SmallMaps.h"
#include "TemporaryFolder.h"

using mrpt_compat::drawing::COctoMapVoxels;
using semantic_map::CSemanticOctoMap;
using semantic_map::TRenderingOptions;

namespace {

/** One wall voxel at x = 3, one road voxel at x = -2, 1 m higher. */
CSemanticOctoMap twoVoxels() {
  CSemanticOctoMap map(0.1, threeClasses());
  map.insertObservation(labeledPoints({{3.05f, 0.05f, 0.05f}, {-2.05f, 0.05f, 1.05f}}, {3, 1}));
  return map;
}

COctoMapVoxels::Ptr voxelsOf(const CSemanticOctoMap& map) {
  mrpt_compat::drawing::CSetOfObjects objects;
  map.getVisualizationInto(objects);
  return objects.getByClass<COctoMapVoxels>();
}

constexpr auto kOccupied = mrpt_compat::drawing::VOXEL_SET_OCCUPIED;
constexpr auto kFree = mrpt_compat::drawing::VOXEL_SET_FREESPACE;

}  // namespace

TEST(MapVisualization, occupiedCellsAreBoxesInTheirClassesColors) {
  const auto voxels = voxelsOf(twoVoxels());
  ASSERT_TRUE(voxels);
  ASSERT_EQ(voxels->getVoxelCount(kOccupied), 2u);
  EXPECT_EQ(voxels->getVoxelCount(kFree), 0u);
  for (int i = 0; i < 2; ++i) {
    const auto& voxel = voxels->getVoxel(kOccupied, i);
    const bool wall = voxel.coords.x > 0;
    EXPECT_NEAR(voxel.coords.x, wall ? 3.05 : -2.05, 1e-5);
    EXPECT_NEAR(voxel.side_length, 0.1, 1e-9);
    EXPECT_EQ(voxel.color, wall ? mrpt::img::TColor(40, 60, 210) : mrpt::img::TColor(200, 30, 30));
  }
}

TEST(MapVisualization, nothingIsDrawnWhereMrptSaysSo) {
  CSemanticOctoMap map = twoVoxels();
  map.genericMapParams.enableSaveAs3DObject = false;
  EXPECT_FALSE(voxelsOf(map));
  EXPECT_FALSE(voxelsOf(CSemanticOctoMap()));
}

TEST(MapVisualization, optionsChooseTheCells) {
  CSemanticOctoMap map = twoVoxels();
  map.renderingOptions.free = true;
  EXPECT_GT(voxelsOf(map)->getVoxelCount(kFree), 10u);
  map.renderingOptions = {};
  map.renderingOptions.maxHeight = 0.5;
  EXPECT_EQ(voxelsOf(map)->getVoxelCount(kOccupied), 1u);
  map.renderingOptions = {};
  map.renderingOptions.minHeight = 0.5;
  EXPECT_EQ(voxelsOf(map)->getVoxelCount(kOccupied), 1u);
}

TEST(MapVisualization, colorsCanShowEntropy) {
  CSemanticOctoMap map = twoVoxels();
  map.renderingOptions.coloring = TRenderingOptions::Coloring::Entropy;
  const auto p =
      map.tree().distribution(*map.tree().search(map.tree().coordToKey(3.05, 0.05, 0.05)));
  double entropy = 0;
  for (const double q : p) entropy -= q * std::log(q);
  const double certain = 1 - entropy / std::log(4.0);
  const auto color = voxelsOf(map)->getVoxel(kOccupied, 0).color;
  EXPECT_NEAR(color.R, std::min(235.0, 235 * (2 - 2 * certain)), 1);
  EXPECT_NEAR(color.G, std::min(215.0, 215 * 2 * certain), 1);
}

TEST(MapVisualization, theCompressedMapCanBeShownInstead) {
  CSemanticOctoMap map(0.2, threeClasses());
  map.setAbstraction(someAbstraction());
  fill(map);
  map.renderingOptions.free = true;
  const auto count = [](const CSemanticOctoMap& m) {
    return voxelsOf(m)->getVoxelCount(kOccupied) + voxelsOf(m)->getVoxelCount(kFree);
  };
  EXPECT_EQ(count(map), map.tree().getNumLeafNodes());
  map.renderingOptions.compressed = true;
  const auto compressed = map.compress();
  EXPECT_EQ(count(map), compressed->tree().getNumLeafNodes());
  EXPECT_LT(count(map), map.tree().getNumLeafNodes());
  map.setAbstraction({});
  EXPECT_EQ(count(map), map.tree().getNumLeafNodes());
}

TEST(MapVisualization, theBoundingBoxHoldsAllNodes) {
  const auto box = twoVoxels().boundingBox();
  EXPECT_NEAR(box.min.x, -2.1, 1e-5);
  EXPECT_NEAR(box.max.x, 3.1, 1e-5);
  EXPECT_NEAR(box.max.z, 1.1, 1e-5);
  const auto empty = CSemanticOctoMap().boundingBox();
  EXPECT_EQ(empty.min.x, 0);
  EXPECT_EQ(empty.max.x, 0);
}

TEST(MapVisualization, savesItsOwnFileAndAScene) {
  const TemporaryFolder folder;
  const CSemanticOctoMap map = twoVoxels();
  map.saveMetricMapRepresentationToFile((folder / "map").string());
  const CSemanticOctoMap read(semantic_octree::loadTree((folder / "map.semantic").string()));
  EXPECT_TRUE(bytesOf(read) == bytesOf(map));
  mrpt_compat::Scene scene;
  ASSERT_TRUE(scene.loadFromFile((folder / "map.3Dscene").string()));
  EXPECT_TRUE(
      scene.getByClass<mrpt_compat::drawing::CSetOfObjects>()->getByClass<COctoMapVoxels>());
  EXPECT_THROW(map.saveMetricMapRepresentationToFile("/no/such/folder/map"), std::runtime_error);
}
