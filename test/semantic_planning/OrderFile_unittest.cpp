#include <gtest/gtest.h>
#include <semantic_planning/planner/OrderFile.h>

#include <cmath>

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
  EXPECT_TRUE(
      contains(orderError("best_to_worst: [road, [grass, road]]"), "'road' is named twice"));
  EXPECT_TRUE(contains(orderError("best_to_worst: []"), "best_to_worst"));
  EXPECT_TRUE(contains(orderError("best_to_worst: [road"), "order.yaml"));
  EXPECT_TRUE(contains(orderError("{}"), "'best_to_worst' is missing"));
  EXPECT_NE(errorOf([] { loadClassOrder("nowhere.yaml", PaintedWorld::classTable()); }), "");
}

TEST_F(OrderFile, ratesAreOfAllRanksButTheBest) {
  const auto load = [&](const std::string& rates) {
    return loadClassOrder(
        folder.write("order.yaml", "best_to_worst: [road, grass, mud, unknown]\n" + rates),
        PaintedWorld::classTable());
  };
  const auto usual = load(""), own = load("rates: [0.5, 3, inf]\n");
  EXPECT_EQ(usual.rate(0), 0);
  EXPECT_EQ(usual.rate(1), 4);
  EXPECT_EQ(usual.rate(3), 36);
  EXPECT_EQ(own.rate(1), 0.5);
  EXPECT_TRUE(std::isinf(own.rate(3)));
  const auto error = [&](const std::string& rates) { return errorOf([&] { load(rates); }); };
  EXPECT_TRUE(contains(error("rates: [1, 2]"), "2 rates for 4 ranks"));
  EXPECT_TRUE(contains(error("rates: [3, 2, 5]"), "rate 2, expected a number from 3"));
  EXPECT_TRUE(contains(error("rates: [1, 2, 1e9]"), "to 1000, or inf"));
  EXPECT_TRUE(contains(error("rates: [1, 2, much]"), "rates"));
  EXPECT_TRUE(contains(error("rates: 4"), "not a list"));
}
