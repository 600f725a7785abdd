// What memory that runs out leaves of maps, files and answers.
#include "FailingAllocations.h"

#include <map_operations/MapOperations.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_map/MapFiles.h>

#include <optional>
#include <sstream>

#include "SmallMaps.h"
#include "TemporaryFolder.h"

using semantic_map::CSemanticOctoMap;

namespace {

CSemanticOctoMap smallMap() {
  CSemanticOctoMap map(0.5, threeClasses());
  map.insertObservation(labeledPoints({{1, 0, 0}, {2, 1, 0}, {2, 1, 2}}, {1, 2, 3}));
  return map;
}

/** \return how often an operation on a map failed, which must leave it as it was */
template <typename Operation>
int sweep(const CSemanticOctoMap& before, const Operation& operation) {
  std::optional<CSemanticOctoMap> map;
  return failEachAllocation([&] { map.emplace(before); }, [&] { operation(*map); },
                            [&] { EXPECT_TRUE(map->tree() == before.tree()); });
}

/** Checks that a map is written as a whole, or refused. */
template <typename Write>
int sweepWriting(const CSemanticOctoMap& map, const Write& write) {
  std::string complete;
  const int failures = sweep(map, [&](CSemanticOctoMap& m) {
    std::ostringstream out;
    write(out, m.tree());
    complete = out.str();
  });
  EXPECT_FALSE(complete.empty());
  return failures;
}

}  // namespace

TEST(FailingAllocations, whileAMapIsExportedOrArchivedLeaveIt) {
  using namespace semantic_map;
  const CSemanticOctoMap map = smallMap();
  EXPECT_GT(sweepWriting(map, [](auto& out, auto& tree) { writePly(out, tree); }), 3);
  EXPECT_GT(sweepWriting(map, [](auto& out, auto& tree) { writeCsv(out, tree); }), 3);
  EXPECT_GT(sweepWriting(map, [](auto& out, auto& tree) { writeOcTree(out, tree); }), 3);
  EXPECT_GT(sweepWriting(map, [](auto& out, auto& tree) { writeColorOcTree(out, tree); }), 3);
  EXPECT_GT(sweepWriting(map, [](auto& out, auto& tree) { writeBinaryOcTree(out, tree); }), 3);
  EXPECT_GT(sweep(map, [](CSemanticOctoMap& m) { bytesOf(m); }), 3);
}

TEST(FailingAllocations, whileAnArchiveIsReadLeaveTheMap) {
  const std::string bytes = bytesOf(smallMap());
  CSemanticOctoMap empty(0.1, threeClasses());
  EXPECT_GT(sweep(empty, [&](CSemanticOctoMap& m) { readBytes(m, bytes); }), 3);
}

TEST(FailingAllocations, whileAnObservationIsInsertedLeaveTheMapOrABrokenOne) {
  const CSemanticOctoMap before = smallMap();
  CSemanticOctoMap after = before;
  const auto observation = labeledPoints({{3, 1, 0}, {2, -1, 0}}, {2, 1});
  ASSERT_TRUE(after.insertObservation(observation));
  std::optional<CSemanticOctoMap> map;
  bool inserted = false;
  int refused = 0;
  const int thrown = failEachAllocation(  // it says false, or throws where it cannot even say why
      [&] {
        map.emplace(before);
        map->logger().logging_enable_console_output = false;
      },
      [&] {
        inserted = map->insertObservation(observation);
        failAllocation(-1);
        if (!inserted) throw std::bad_alloc();
        EXPECT_TRUE(map->tree() == after.tree());
      },
      [&] {
        ++refused;
        EXPECT_TRUE(map->tree().isBroken() || map->tree() == before.tree());
      });
  EXPECT_GT(thrown, 3);
  EXPECT_EQ(refused, thrown);
}

TEST(FailingAllocations, whileTheFilterOrTheAbstractionChangesLeaveBoth) {
  CSemanticOctoMap empty(0.5, threeClasses());
  empty.setAbstraction(someAbstraction());
  std::optional<CSemanticOctoMap> map;
  const int failures = failEachAllocation(
      [&] {
        map.emplace(empty);
        map->logger().logging_enable_console_output = false;
      },
      [&] {
        map->insertionOptions.filter.accuracy = 0.7;
        if (!map->insertObservation(labeledPoints({{1, 0, 0}}, {1}))) throw std::bad_alloc();
      },
      [&] { EXPECT_TRUE(map->tree().isBroken() || hasAbstraction(map->tree())); });
  EXPECT_GT(failures, 3);
  EXPECT_TRUE(hasAbstraction(map->tree()));
}

TEST(FailingAllocations, whileAMapOfOctomapsIsReadAreErrors) {
  const TemporaryFolder folder;
  std::ostringstream out;
  writeOcTree(out, smallMap().tree());
  const auto file = folder.write("a.ot", out.str());
  std::size_t leaves = 0;
  EXPECT_GT(failEachAllocation(
                [] {}, [&] { leaves = semantic_map::importOctomapFile(file).getNumLeafNodes(); },
                [&] { EXPECT_EQ(leaves, 0u); }),
            3);
  EXPECT_EQ(leaves, smallMap().tree().getNumLeafNodes());
}
