#include <colored_graph/EdgeModelNames.h>
#include <gtest/gtest.h>

using namespace colored_graph;

TEST(EdgeModelNames, leadBackToTheModels) {
  EXPECT_EQ(edgeModels().size(), 3u);
  for (const auto& [name, model] : edgeModels()) EXPECT_EQ(nameOf(model), name);
  EXPECT_EQ(edgeModels().at("sweep"), EdgeModel::Sweep);
}
