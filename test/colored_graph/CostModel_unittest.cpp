#include <colored_graph/CostModel.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

using namespace colored_graph;

namespace {

/** Each name is used once and leads back to its value. */
template <class E>
void expectOneNameEach(std::size_t values) {
  std::set<std::string> names;
  for (const auto& [name, value] : choicesOf(E())) {
    EXPECT_STREQ(nameOf(value), name);
    names.insert(name);
  }
  EXPECT_EQ(names.size(), values);
}

}  // namespace

TEST(CostModel, everyEdgeModelAndCostHasOneName) {
  expectOneNameEach<EdgeModel>(3);
  expectOneNameEach<CostKind>(2);
  EXPECT_STREQ(nameOf(EdgeModel::Sweep), "sweep");
  EXPECT_STREQ(nameOf(CostKind::ArcLength), "length");
}
