#include <colored_graph/ModelNames.h>
#include <gtest/gtest.h>

using namespace colored_graph;

TEST(ModelNames, areThoseOfAllModels) {
  EXPECT_EQ(choicesOf(EdgeModel()).size(), 3u);
  for (const auto& [name, model] : choicesOf(EdgeModel())) EXPECT_STREQ(nameOf(model), name);
  EXPECT_STREQ(nameOf(EdgeModel::Sweep), "sweep");
  EXPECT_EQ(choicesOf(CostKind()).size(), 2u);
}
