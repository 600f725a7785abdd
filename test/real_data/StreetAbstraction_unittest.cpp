#include <gtest/gtest.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_types/ClassTable.h>

#include "DataSets.h"
#include "SharedData.h"

using namespace semantic_octree;

namespace {

AbstractionOptions roadsNotPlants(const ClassTable& table) {
  AbstractionOptions o;
  o.weights.terms = {tree_abstraction::relevant("road", 1.0, {*table.find("road")}),
                     tree_abstraction::irrelevant("vegetation", 0.3, {*table.find("vegetation")}),
                     tree_abstraction::irrelevant("terrain", 0.3, {*table.find("terrain")})};
  o.weights.alpha = 0.002;
  o.blockSize = 3.2;
  return o;
}

}  // namespace

TEST(StreetAbstraction, incrementalEqualsBatchAfterEveryScanAndPrunedEqualsUnpruned) {
  SKIP_WITHOUT_DATA("semantic_kitti");
  const ClassTable table =
      semantic_types::loadClassTable(MSO_SOURCE_DIR "/config/classes/semantic_kitti.yaml");
  const AbstractionOptions options = roadsNotPlants(table);
  InsertionOptions insertion;
  insertion.maxRange = 25;
  SemanticOcTree pruned(0.2, table), unpruned(0.2, table);
  unpruned.setPruning(false);
  setAbstraction(pruned, options), setAbstraction(unpruned, options);
  for (const LabeledFrame& f : readSemanticKitti(sharedDataDir() / "semantic_kitti/00", table)) {
    pruned.insert(f.cloud, f.T_map_sensor, insertion);
    unpruned.insert(f.cloud, f.T_map_sensor, insertion);
    SemanticOcTree batch(pruned);
    dropAbstraction(batch);
    setAbstraction(batch, options);
    ASSERT_TRUE(pruned == batch);
  }
  const Abstraction a(pruned), b(unpruned);
  EXPECT_EQ(a.leaves(), b.leaves());
  EXPECT_EQ(a.objective(), b.objective());
  const auto full = a.measures().full, unprunedFull = b.measures().full;
  for (std::size_t t = 0; t < options.weights.terms.size(); ++t)
    EXPECT_NEAR(full.information[t], unprunedFull.information[t], 1e-12);
  EXPECT_LT(a.leaves().size(), pruned.getNumLeafNodes() / 5);
}
