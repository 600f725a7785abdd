#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <semantic_abstraction/Abstraction.h>

#include "SmallMaps.h"
#include "TemporaryFolder.h"

using semantic_map::CSemanticOctoMap;
using semantic_map::TAbstractionOptions;
using semantic_octree::AbstractionOptions;

namespace {

TAbstractionOptions someOptions() {
  TAbstractionOptions o;
  o.relevant = "road: 1, tree+wall: 0.5";
  o.everything = 0.1;
  o.alpha = 0.01;
  o.blockSize = 3.2;
  return o;
}

std::vector<std::pair<octomap::OcTreeKey, unsigned>> leavesOf(CSemanticOctoMap& map) {
  std::vector<std::pair<octomap::OcTreeKey, unsigned>> leaves;
  for (const auto& l : map.abstraction().leaves()) leaves.emplace_back(l.key(), l.depth);
  return leaves;
}

}  // namespace

TEST(MapAbstraction, comesFromTheIniFile) {
  const mrpt::config::CConfigFileMemory ini(
      "[m]\nsemanticOctoMap_count=1\n"
      "[m_semanticOctoMap_00_abstractionOpts]\n"
      "relevant = occupied: 2\nalpha = 0.03 // per nat\nunknown = uniform\n"
      "regions = box 0 0 0 1 2 3 4; sphere 1 2 3 0.5 0; corridor 0 0 0 5 0 0 1 2\n");
  mrpt::maps::TSetOfMetricMapInitializers initializers;
  initializers.loadFromConfigFile(ini, "m");
  mrpt::maps::CMultiMetricMap maps;
  maps.setListOfMaps(initializers);
  auto& map = dynamic_cast<CSemanticOctoMap&>(*maps.maps.at(0));
  const AbstractionOptions& o = map.abstraction().options();
  ASSERT_EQ(o.weights.terms.size(), 1u);
  EXPECT_EQ(o.weights.terms[0].weight, 2);
  EXPECT_EQ(o.weights.terms[0].groups, (std::vector<std::vector<int>>{{1}}));
  EXPECT_EQ(o.weights.alpha, 0.03);
  EXPECT_EQ(o.unknown, AbstractionOptions::Unknown::Uniform);
  ASSERT_EQ(o.regions.size(), 3u);
  EXPECT_EQ(o.regions[0].b, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(o.regions[1].radius, 0.5);
  EXPECT_EQ(o.regions[2].weight, 2);
}

TEST(MapAbstraction, isCopiedArchivedAndGoesOn) {
  CSemanticOctoMap map(0.2, threeClasses());
  map.setAbstraction(someOptions());
  fill(map);
  CSemanticOctoMap copy(map), read;
  readBytes(read, bytesOf(map));
  ASSERT_GT(leavesOf(map).size(), 10u);
  fill(map), fill(copy), fill(read);
  for (CSemanticOctoMap* other : {&copy, &read}) {
    EXPECT_TRUE(other->tree() == map.tree());
    EXPECT_EQ(leavesOf(*other), leavesOf(map));
    EXPECT_EQ(other->abstractionOptions().relevant, map.abstractionOptions().relevant);
  }
}

TEST(MapAbstraction, compressedMapIsAMapWithTheSameOptions) {
  CSemanticOctoMap map(0.2, threeClasses());
  map.setAbstraction(someOptions());
  map.insertionOptions.scan.maxRange = 4.5;
  fill(map);
  const auto compressed = map.compress();
  EXPECT_EQ(compressed->insertionOptions.scan.maxRange, 4.5);
  EXPECT_EQ(compressed->tree().getNumLeafNodes(), leavesOf(map).size());
  EXPECT_LT(compressed->tree().getNumLeafNodes(), map.tree().getNumLeafNodes());
}

TEST(MapAbstraction, withoutWeightsNoneIsKept) {
  CSemanticOctoMap map(0.2, threeClasses());
  map.setAbstraction(someOptions());
  map.setAbstraction(TAbstractionOptions());
  EXPECT_FALSE(hasAbstraction(map.tree()));
  EXPECT_THROW(map.abstraction(), std::logic_error);
}

TEST(MapAbstraction, namesWhatIsWrong) {
  for (const auto& [line, word] : {std::pair("relevant = river: 1", "'river'"),
                                   {"relevant = road: nan", "road: nan"},
                                   {"unknown = perhaps", "perhaps"},
                                   {"regions = box 1 2 3", "box 1 2 3"},
                                   {"beta = 1", "'beta'"}}) {
    const mrpt::config::CConfigFileMemory ini(std::string("[map_abstractionOpts]\n") + line);
    const std::string error = errorOf([&] {
      TAbstractionOptions options;
      options.loadFromConfigFile(ini, "map_abstractionOpts");
      options.forClasses(threeClasses());
    });
    EXPECT_TRUE(contains(error, word)) << line << ": " << error;
  }
}
