#include <gtest/gtest.h>
#include <reference/GTreeSearch.h>
#include <tree_abstraction/AlphaPath.h>
#include <tree_abstraction/Information.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

using namespace tree_abstraction;
using namespace reference;
using nlohmann::json;

namespace {

/** 1e-12 of the number; numbers near 0 come from terms of size 1. */
void expectClose(double actual, double expected) {
  EXPECT_NEAR(actual, expected, std::max(1e-12 * std::abs(expected), 2e-15));
}

void expectClose(const std::vector<double>& actual, const json& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i) expectClose(actual[i], expected[i]);
}

json loadVectors() {
  std::ifstream file(MSO_SOURCE_DIR "/test/tree_abstraction/vectors.json");
  return json::parse(file);
}

AbstractionWeights readWeights(const json& test) {
  AbstractionWeights weights{{}, test["alpha"]};
  for (const auto& term : test["terms"]) {
    const std::string name = "term " + std::to_string(weights.terms.size());
    weights.terms.push_back({name, term["weight"], term["groups"]});
  }
  return weights;
}

void addNode(const json& node, const json& test, double volume, std::int32_t parent, Forest& tree) {
  const auto classes = test["numClasses"].get<std::size_t>() + 1;
  if (node.is_null()) {
    const double weight = test["missingWeight"].get<double>() * volume;
    tree.addMissing(parent, weight,
                    std::vector<double>(classes, 1.0 / static_cast<double>(classes)));
  } else if (node.is_array()) {
    tree.addLeaf(parent, volume, node);
  } else {
    const auto inner = tree.addInner(parent);
    for (const auto& child : node["children"]) addNode(child, test, volume / 8, inner, tree);
  }
}

Forest readTree(const json& test) {
  Forest tree;
  addNode(test["tree"], test, 1.0, Forest::kNoParent, tree);
  return tree;
}

/** Number of the node at the end of a path of child numbers. */
std::size_t follow(const Forest& tree, const json& path) {
  std::int32_t n = 0;
  for (const std::size_t child : path) n = tree[n].children[child];
  return static_cast<std::size_t>(n);
}

void expectNode(const SearchResult& found, const std::vector<double>& tau, const json& expected) {
  SCOPED_TRACE(expected.dump());
  const std::size_t n = follow(found.forest, expected["path"]);
  const NodeValues& values = found.values[n];
  expectClose(values.probability, expected["probability"]);
  expectClose(values.splitEntropy, expected["splitEntropy"]);
  expectClose(values.divergence, expected["divergence"]);
  expectClose(values.v, expected["v"]);
  expectClose(values.g, expected["g"]);
  expectClose(tau[n], expected["tau"]);
}

void expectMeasures(const SearchResult& found, const json& expected) {
  expectClose(found.objective, expected["objective"]);
  expectClose(found.optimal.leafEntropy, expected["leafEntropy"]);
  expectClose(found.full.leafEntropy, expected["fullLeafEntropy"]);
  expectClose(found.optimal.information, expected["information"]);
  expectClose(found.full.information, expected["fullInformation"]);
  EXPECT_EQ(found.optimal.numLeaves, expected["leaves"]);
  EXPECT_EQ(found.full.numLeaves, expected["allLeaves"]);
  EXPECT_EQ(found.optimal.numKnownLeaves, expected["knownLeaves"]);
  EXPECT_EQ(found.full.numKnownLeaves, expected["allKnownLeaves"]);
  for (std::size_t t = 0; t < found.full.information.size(); ++t) {
    expectClose(natsToBits(found.optimal.information[t]), expected["informationBits"][t]);
    ASSERT_TRUE(found.retention(t).has_value());
    expectClose(*found.retention(t), expected["retention"][t]);
  }
}

}  // namespace

TEST(Vectors, searchAndAlphaPathGiveTheNumbersOfEachCase) {
  const nlohmann::json vectors = loadVectors();
  for (const auto& test : vectors["cases"]) {
    SCOPED_TRACE(test["name"]);
    const json& expected = test["expected"];
    const AbstractionWeights weights = readWeights(test);
    const auto found = findOptimalTree(readTree(test), weights);
    const auto tau = collapseAlphas(found.parents(), found.gains(weights), found.prices());
    expectMeasures(found, expected);
    for (const auto& node : expected["nodes"]) expectNode(found, tau, node);
    std::vector<char> interior(found.forest.size(), false);
    for (const auto& path : expected["interior"]) interior[follow(found.forest, path)] = true;
    EXPECT_EQ(found.expanded(), interior);
  }
}

TEST(Vectors, isolatedLeavesPayFromTheirBreakEvenRatioOn) {
  const nlohmann::json vectors = loadVectors();
  for (const auto& expected : vectors["breakEven"]) {
    SCOPED_TRACE(expected.dump());
    Forest tree;
    const auto root = tree.addInner(Forest::kNoParent);
    for (int i = 0; i < 8; ++i) {
      const double one = i < expected["positiveChildren"] ? 1.0 : 0.0;
      tree.addLeaf(root, 0.125, {1.0 - one, one});
    }
    const auto expands = [&](double ratio) {
      return findOptimalTree(tree, {{relevant("one", ratio, {1})}, 1.0}).values.front().expanded;
    };
    const double ratio = expected["ratio"];
    EXPECT_FALSE(expands(ratio * (1 - 1e-10)));
    EXPECT_TRUE(expands(ratio * (1 + 1e-10)));
    const auto found = findOptimalTree(tree, {{relevant("one", ratio, {1})}, 1.0});
    expectClose(natsToBits(found.full.information[0]), expected["divergenceBits"]);
  }
}
