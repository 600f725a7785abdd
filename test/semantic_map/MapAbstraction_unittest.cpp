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

TEST(MapAbstraction, compressedMapIsAMapWithTheSameOptions) {
  CSemanticOctoMap map(0.2, threeClasses());
  map.setAbstraction(someAbstraction());
  map.insertionOptions.scan.maxRange = 4.5;
  fill(map);
  const auto compressed = map.compress();
  EXPECT_EQ(compressed->insertionOptions.scan.maxRange, 4.5);
  EXPECT_EQ(compressed->tree().getNumLeafNodes(), map.abstraction().leaves().size());
  EXPECT_LT(compressed->tree().getNumLeafNodes(), map.tree().getNumLeafNodes());
}

TEST(MapAbstraction, withoutWeightsNoneIsKept) {
  CSemanticOctoMap map(0.2, threeClasses());
  map.setAbstraction(someAbstraction());
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

// Maps that forget, by the stamps of their observations.

using mrpt::Clock;
using semantic_map::ObservationClock;
using semantic_octree::CellState;

constexpr double kStart = 1.7e9;  // seconds

Clock::time_point at(double seconds) { return Clock::fromDouble(kStart + seconds); }

semantic_types::ClassTable passingTrees() {
  semantic_types::ClassTable table = threeClasses();
  table.setHalfLife(2, 2);
  return table;
}

/** A tree at (3, 0.5), seen at a time, or a wall at (-3, 0.5). */
bool insert(CSemanticOctoMap& map, double seconds, bool tree = false) {
  auto observation = labeledPoints({{tree ? 3.05f : -3.05f, 0.55f, 0.05f}},
                                   {semantic_types::ClassId(tree ? 2 : 3)});
  observation.timestamp = at(seconds);
  return map.insertObservation(observation);
}

CellState::Status treeIn(const CSemanticOctoMap& map) {
  return map.tree().query(3.05, 0.55, 0.05).status;
}

}  // namespace

TEST(ObservationClock, countsTimeWithinARecordingOnce) {
  ObservationClock clock(60);
  EXPECT_EQ(clock.secondsUntil(at(5)), 0);
  clock.note(at(5));
  EXPECT_DOUBLE_EQ(clock.secondsUntil(at(6.5)), 1.5);
  clock.note(at(6.5));
  EXPECT_EQ(clock.secondsUntil(at(6)), 0) << "another sensor, a little late";
  clock.note(at(6));
  EXPECT_DOUBLE_EQ(clock.secondsUntil(at(7.5)), 1);
  EXPECT_EQ(clock.secondsUntil(Clock::time_point()), 0);
  clock.note(Clock::time_point());
  EXPECT_DOUBLE_EQ(clock.secondsUntil(at(66.5)), 60);
  EXPECT_EQ(clock.secondsUntil(at(67)), 0) << "another recording";
  clock.note(at(67));
  EXPECT_DOUBLE_EQ(clock.secondsUntil(at(68)), 1);
  clock.note(at(-500));
  EXPECT_DOUBLE_EQ(clock.secondsUntil(at(-499)), 1) << "an older recording";
  clock.setMaxGap(0);
  EXPECT_DOUBLE_EQ(clock.secondsUntil(at(9500)), 10000);
}

TEST(MapAging, whatNobodySeesAnyMoreIsUnknownAfterAFewHalfLives) {
  CSemanticOctoMap map(0.1, passingTrees());
  ASSERT_TRUE(insert(map, 0, true));
  for (int i = 1; i <= 8; ++i) ASSERT_TRUE(insert(map, i));
  EXPECT_EQ(treeIn(map), CellState::Status::Occupied);
  for (int i = 9; i <= 11; ++i) ASSERT_TRUE(insert(map, i));
  EXPECT_EQ(treeIn(map), CellState::Status::Unknown);
  EXPECT_EQ(map.tree().query(-3.05, 0.55, 0.05).status, CellState::Status::Occupied);
  EXPECT_DOUBLE_EQ(map.tree().clock(), 11);
}

TEST(MapAging, aGapIsCountedOnlyIfTheUserSaysSo) {
  for (const bool counted : {false, true}) {
    CSemanticOctoMap map(0.1, passingTrees());
    map.insertionOptions.maxGap = counted ? 0 : 30;
    insert(map, 0, true);
    insert(map, 3600);
    EXPECT_EQ(treeIn(map), counted ? CellState::Status::Unknown : CellState::Status::Occupied);
    EXPECT_DOUBLE_EQ(map.tree().clock(), counted ? 3600 : 0);
  }
}

TEST(MapAging, aMapFromAnArchiveGoesOnWhereItStopped) {
  CSemanticOctoMap map(0.1, passingTrees()), loaded;
  insert(map, 0, true);
  insert(map, 1.1);
  readBytes(loaded, bytesOf(map));
  EXPECT_TRUE(loaded.tree() == map.tree());
  EXPECT_DOUBLE_EQ(loaded.tree().clock(), 1.1);
  insert(loaded, 40);  // nobody was there meanwhile
  EXPECT_DOUBLE_EQ(loaded.tree().clock(), 1.1);
  insert(loaded, 40.5);
  EXPECT_DOUBLE_EQ(loaded.tree().clock(), 1.6);
  EXPECT_EQ(treeIn(loaded), CellState::Status::Occupied);
}

TEST(MapAging, anObservationThatIsRefusedLetsNoTimePass) {
  CSemanticOctoMap map(0.1, passingTrees());
  map.logger().logging_enable_console_output = false;
  insert(map, 0, true);
  const std::string before = bytesOf(map);
  auto observation = labeledPoints({{1, 1, 1}}, {2});
  observation.timestamp = at(10);
  EXPECT_FALSE(map.insertObservation(observation, mrpt::poses::CPose3D(1e6, 0, 0, 0, 0, 0)));
  EXPECT_TRUE(bytesOf(map) == before);
  insert(map, 2);
  EXPECT_DOUBLE_EQ(map.tree().clock(), 2);
  map.clear();
  EXPECT_EQ(map.tree().clock(), 0);
}
