#include <colored_graph/ClassOrder.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

using namespace colored_graph;

namespace {

/** The message of the exception that making this order throws. */
std::string refusal(int classes, const std::vector<std::vector<GraphClass>>& bestToWorst) {
  try {
    ClassOrder(classes, bestToWorst);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST(ClassOrder, ranksClassesAndForbidsTheRest) {
  const ClassOrder order(5, {{3}, {0, 4}, {1}});
  EXPECT_EQ(order.classes(), 5);
  EXPECT_EQ(order.ranks(), 3);
  EXPECT_EQ(order.rank(3), 0);
  EXPECT_EQ(order.rank(0), 1);
  EXPECT_EQ(order.rank(4), 1);
  EXPECT_EQ(order.rank(1), 2);
  EXPECT_EQ(order.rank(2), kForbidden);
}

TEST(ClassOrder, saysWhatIsWrongWithAnOrder) {
  EXPECT_EQ(refusal(0, {{0}}), "ClassOrder: a graph has at least one class, not 0");
  EXPECT_EQ(refusal(3, {}), "ClassOrder: the order is empty: every edge would be forbidden");
  EXPECT_EQ(refusal(3, {{0}, {}}), "ClassOrder: rank 1 has no class");
  EXPECT_EQ(refusal(3, {{0}, {3}}), "ClassOrder: class 3 is not one of the 3 classes");
  EXPECT_EQ(refusal(3, {{0}, {1}, {0}}), "ClassOrder: class 0 is named twice");
  EXPECT_EQ(refusal(3, {{1, 1}}), "ClassOrder: class 1 is named twice");
}

TEST(ClassOrder, hasSixteenRanksAtMost) {
  std::vector<std::vector<GraphClass>> ranks;
  for (GraphClass id = 0; id < 16; ++id) ranks.push_back({id});
  EXPECT_EQ(refusal(17, ranks), "accepted");
  ranks.push_back({16});
  EXPECT_EQ(refusal(17, ranks), "ClassOrder: 17 ranks, at most 16");
}
