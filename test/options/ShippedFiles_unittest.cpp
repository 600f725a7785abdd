#include <gtest/gtest.h>
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_planning/planner/OrderFile.h>
#include <semantic_types/ClassTable.h>

#include <filesystem>

namespace {

namespace fs = std::filesystem;

const fs::path kConfig = fs::path(MSO_SOURCE_DIR) / "config";

/** Calls f(file, table) for the files of a folder whose names begin with that of a class table. */
template <class F>
void forEachWithTable(const std::string& folder, const F& f) {
  for (const auto& table : fs::directory_iterator(kConfig / "classes"))
    for (const auto& file : fs::directory_iterator(kConfig / folder))
      if (file.path().stem().string().rfind(table.path().stem().string(), 0) == 0)
        f(file.path(), semantic_types::loadClassTable(table.path()));
}

}  // namespace

TEST(ShippedFiles, OrdersAreOfTheClassesOfTheirTables) {
  int orders = 0;
  forEachWithTable("orders", [&](const fs::path& file, const auto& classes) {
    EXPECT_NO_THROW(semantic_planning::loadClassOrder(file, classes)) << file;
    ++orders;
  });
  EXPECT_EQ(orders, std::distance(fs::directory_iterator(kConfig / "orders"), {}));
}

TEST(ShippedFiles, WeightsAreFiveSolutionsForTheirTables) {
  int weights = 0;
  forEachWithTable("weights", [&](const fs::path& file, const auto& classes) {
    const auto read = semantic_octree::loadWeights(file, classes);
    ASSERT_EQ(read.size(), 5u) << file;
    std::size_t outcomes = 0;
    for (const auto& term : read.back().weights.terms) outcomes += term.groups.size();
    EXPECT_GE(outcomes, std::size_t(classes.size())) << file << ": the last one has all classes";
    ++weights;
  });
  EXPECT_EQ(weights, std::distance(fs::directory_iterator(kConfig / "weights"), {}));
}
