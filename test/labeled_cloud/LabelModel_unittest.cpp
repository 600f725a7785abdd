#include <gtest/gtest.h>
#include <labeled_cloud/LabelModel.h>

#include "Classes.h"
#include "TemporaryFolder.h"

using namespace labeled_cloud;
using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::LabeledCloud;

namespace {

LabeledCloud cloudOf(const std::vector<ClassId>& classes) {
  LabeledCloud cloud;
  cloud.points.resize(classes.size());
  cloud.classes = classes;
  return cloud;
}

LabeledCloud softCloud(const std::vector<float>& probabilities, std::size_t points) {
  LabeledCloud cloud;
  cloud.points.resize(points);
  cloud.probabilities = probabilities;
  return cloud;
}

ClassTable roadCarTree() { return tableOf({"road", "car", "tree"}); }

}  // namespace

TEST(LabelModel, leavesHardAndSoftLabelsAsTheyAreUnlessToldOtherwise) {
  auto hard = cloudOf({1, 0, 2}), soft = softCloud({0.2f, 0.8f, 0, 0}, 2);
  LabelModel().apply(2, {}, hard);
  LabelModel().apply(2, {}, soft);
  EXPECT_EQ(hard.classes, (std::vector<ClassId>{1, 0, 2}));
  EXPECT_EQ(soft.probabilities, (std::vector<float>{0.2f, 0.8f, 0, 0}));
}

TEST(LabelModel, hardenedRowsKeepTheirLikeliestClass) {
  LabelModel model;
  model.kind = LabelModel::Kind::Hard;
  auto cloud = softCloud({0.2f, 0.8f, 0, 0, 0.6f, 0.4f}, 3);
  model.apply(2, {}, cloud);
  EXPECT_EQ(cloud.classes, (std::vector<ClassId>{2, 0, 1}));
  EXPECT_TRUE(cloud.probabilities.empty());
}

TEST(LabelModel, confidencesBecomeRowsThatShareTheRestAmongTheOthers) {
  auto cloud = cloudOf({2, 0});
  LabelModel().apply(3, {0.5f, 0.9f}, cloud);
  EXPECT_EQ(cloud.probabilities, (std::vector<float>{0.25f, 0.5f, 0.25f, 0, 0, 0}));
  EXPECT_TRUE(cloud.classes.empty());
}

TEST(LabelModel, unsureLabelsAreNone) {
  LabelModel model;
  model.minConfidence = 0.7;
  auto soft = softCloud({0.4f, 0.6f, 0.2f, 0.8f}, 2);
  model.apply(2, {}, soft);
  EXPECT_EQ(soft.probabilities, (std::vector<float>{0, 0, 0.2f, 0.8f}));
  model.kind = LabelModel::Kind::Hard;
  auto hard = cloudOf({1, 2});
  model.apply(2, {0.6f, 0.9f}, hard);
  EXPECT_EQ(hard.classes, (std::vector<ClassId>{0, 2}));
  model.minConfidence = 2;
  EXPECT_TRUE(contains(errorOf([&] { model.validate(); }), "min_confidence is 2"));
}

TEST(ConfusionMatrices, giveTheLikelihoodOfEachTrueClass) {
  const double n = 1e9;  // so many that the blending does not matter
  LabelModel model;
  model.confusion = std::make_shared<ConfusionMatrix>(
      std::vector<std::vector<double>>{{0.8 * n, 0.2 * n}, {0.4 * n, 0.6 * n}});
  auto cloud = cloudOf({1, 2, 0});
  model.apply(2, {}, cloud);
  const std::vector<float> expected = {0.8f / 1.2f, 0.4f / 1.2f, 0.2f / 0.8f, 0.6f / 0.8f, 0, 0};
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(cloud.probabilities[i], expected[i], 1e-6) << i;
}

TEST(ConfusionMatrices, doNotLetAClassWinThatWasNeverSeen) {
  const ConfusionMatrix matrix({{900, 100, 0}, {100, 900, 0}, {0, 0, 0}});
  for (ClassId answered = 1; answered <= 2; ++answered) {
    const float* row = matrix.given(answered);
    EXPECT_GT(row[answered - 1], row[2]);
    EXPECT_NEAR(row[0] + row[1] + row[2], 1, 1e-6);
  }
}

TEST(ConfusionMatrices, tellHowFrequentClassesAre) {
  const auto shares = ConfusionMatrix({{500, 100, 0}, {100, 300, 0}, {0, 0, 0}}).classShares();
  EXPECT_NEAR(shares[0], 0.6, 1e-3);
  EXPECT_NEAR(shares[1], 0.4, 1e-3);
  EXPECT_GT(shares[2], 0);
  EXPECT_NEAR(shares[0] + shares[1] + shares[2], 1, 1e-6);
}

TEST(ConfusionMatrices, areReadByTheNamesOfTheirClasses) {
  const TemporaryFolder folder;
  const auto matrix = loadConfusionMatrix(
      folder.write("c.json", R"({"classes": ["auto", "road"], "fold": {"auto": "car"},
                                 "confusion": [[900, 100], [300, 700]]})"),
      roadCarTree());
  EXPECT_NEAR(matrix.given(2)[1] / matrix.given(2)[0], 3, 0.01);
  EXPECT_EQ(matrix.size(), 3);
}

TEST(ConfusionMatrices, badOnesAreNamed) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& text) {
    return errorOf([&] { loadConfusionMatrix(folder.write("c.yaml", text), roadCarTree()); });
  };
  EXPECT_TRUE(contains(error("classes: [road, car]\nconfusion: [[1, 2]]\n"), "c.yaml:2"));
  EXPECT_TRUE(contains(error("classes: [road, car]\nconfusion: [[1, 2], [3]]\n"), "1 counts"));
  EXPECT_TRUE(contains(error("classes: [road]\nconfusion: [[-1]]\n"), "found -1"));
  EXPECT_TRUE(contains(error("classes: [road]\nconfusion: [[0]]\n"), "all counts are 0"));
  EXPECT_TRUE(contains(error("classes: [bus]\nconfusion: [[1]]\n"), "'bus' is no class"));
  LabelModel model;
  model.confusion = std::make_shared<ConfusionMatrix>(std::vector<std::vector<double>>{{1}});
  auto cloud = cloudOf({1});
  EXPECT_TRUE(contains(errorOf([&] { model.apply(2, {}, cloud); }), "1 classes for a table of 2"));
}
