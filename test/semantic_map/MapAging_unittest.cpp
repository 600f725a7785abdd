// Maps that forget, by the stamps of their observations.
#include <gtest/gtest.h>

#include "SmallMaps.h"
#include "TemporaryFolder.h"

using mrpt::Clock;
using semantic_map::CSemanticOctoMap;
using semantic_map::ObservationClock;
using semantic_octree::CellState;

namespace {

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
