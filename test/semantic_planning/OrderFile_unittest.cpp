#include <gtest/gtest.h>
#include <semantic_planning/planner/OrderFile.h>

#include "PaintedWorld.h"
#include "TemporaryFolder.h"

using namespace semantic_planning;

class OrderFile : public testing::Test {
 protected:
  std::string orderError(const std::string& text) const {
    const auto file = folder.write("order.yaml", text);
    return errorOf([&] { loadClassOrder(file, PaintedWorld::classTable()); });
  }

  TemporaryFolder folder;
};

TEST_F(OrderFile, ranksClassesAsListedAndForbidsTheOthers) {
  const auto file =
      folder.write("order.yaml", "best_to_worst:\n- [road, mud]\n- grass\n- unknown\n");
  const auto order = loadClassOrder(file, PaintedWorld::classTable());
  EXPECT_EQ(order.classes(), 5);
  EXPECT_EQ(order.ranks(), 3);
  EXPECT_EQ(order.rank(PaintedWorld::Road), 0);
  EXPECT_EQ(order.rank(PaintedWorld::Mud), 0);
  EXPECT_EQ(order.rank(PaintedWorld::Grass), 1);
  EXPECT_EQ(order.rank(semantic_types::kNoClass), 2);
  EXPECT_EQ(order.rank(PaintedWorld::Wall), colored_graph::kForbidden);
}

TEST_F(OrderFile, isStrictAboutClassesAndKeys) {
  EXPECT_TRUE(contains(orderError("best_to_worst: [road, lava]"), "no class 'lava'"));
  EXPECT_TRUE(contains(orderError("best_to_worst:\n- road\n- lava"), "order.yaml:3"));
  EXPECT_TRUE(contains(orderError("best_to_worst: [road]\nworse: [grass]"), "unknown key 'worse'"));
  EXPECT_TRUE(contains(orderError("best_to_worst: [road, [grass, road]]"), "twice"));
  EXPECT_TRUE(contains(orderError("best_to_worst: []"), "best_to_worst"));
  EXPECT_TRUE(contains(orderError("best_to_worst: [road"), "order.yaml"));
  EXPECT_TRUE(contains(orderError("{}"), "'best_to_worst' is missing"));
  EXPECT_NE(errorOf([] { loadClassOrder("nowhere.yaml", PaintedWorld::classTable()); }), "");
}

TEST_F(OrderFile, thoseOfTheRepositoryLoad) {
  const std::filesystem::path config = std::filesystem::path(MSO_SOURCE_DIR) / "config";
  semantic_types::ClassTable kitti;
  for (const char* name : {"road", "parking", "sidewalk", "terrain"}) kitti.add(name, {});
  EXPECT_EQ(loadClassOrder(config / "orders/semantic_kitti.yaml", kitti).ranks(), 5);
}
