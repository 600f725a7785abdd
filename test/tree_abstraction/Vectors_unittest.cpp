#include <gtest/gtest.h>
#include <reference/GTreeSearch.h>
#include <reference/VectorTree.h>
#include <tree_abstraction/AlphaPath.h>

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

void addNode(const json& node, const json& test, double volume, VectorTree::Node parent,
             VectorTree& tree) {
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

VectorTree readTree(const json& test) {
  VectorTree tree(test["numClasses"]);
  addNode(test["tree"], test, 1.0, VectorTree::kNoParent, tree);
  return tree;
}

/** Breadth-first index of the node at the end of a path of child numbers. */
std::size_t follow(const BreadthFirstTree& tree, const json& path) {
  std::size_t n = 0;
  for (const std::size_t child : path) n = static_cast<std::size_t>(tree.firstChild[n]) + child;
  return n;
}

void expectNode(const SearchResult& found, const std::vector<double>& tau, const json& expected) {
  SCOPED_TRACE(expected.dump());
  const std::size_t n = follow(found.tree, expected["path"]);
  const std::size_t numTerms = found.full.information.size();
  expectClose(found.information.probability[n], expected["probability"]);
  expectClose(found.information.splitEntropy[n], expected["splitEntropy"]);
  for (std::size_t t = 0; t < numTerms; ++t) {
    expectClose(found.information.divergence[n * numTerms + t], expected["divergence"][t]);
  }
  expectClose(found.values.v[n], expected["v"]);
  expectClose(found.values.g[n], expected["g"]);
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
  for (std::size_t t = 0; t < found.retention.size(); ++t) {
    expectClose(natsToBits(found.optimal.information[t]), expected["informationBits"][t]);
    ASSERT_TRUE(found.retention[t].has_value());
    expectClose(*found.retention[t], expected["retention"][t]);
  }
}

}  // namespace

TEST(Vectors, searchAndAlphaPathGiveTheNumbersOfEachCase) {
  const nlohmann::json vectors = loadVectors();
  for (const auto& test : vectors["cases"]) {
    for (const auto form : {DivergenceForm::Stable, DivergenceForm::Fast}) {
      SCOPED_TRACE(test["name"]);
      const json& expected = test["expected"];
      const VectorTree tree = readTree(test);
      const auto found = findOptimalTree(tree, readWeights(test), {form});
      const auto tau = collapseAlphas(found.tree.parent, found.values.gain, found.values.price);
      expectMeasures(found, expected);
      for (const auto& node : expected["nodes"]) expectNode(found, tau, node);
      std::vector<char> interior(found.tree.size(), false);
      for (const auto& path : expected["interior"]) interior[follow(found.tree, path)] = true;
      EXPECT_EQ(found.expanded, interior);
    }
  }
}

TEST(Vectors, nearlyEqualChildrenKeepTheirDivergence) {
  const json expected = loadVectors()["nearlyEqual"];
  const auto p = expected["p"].get<std::vector<double>>();
  const std::vector<double> pi(8, 0.125);
  // The children differ by 1e-9: their divergence is known as well as these differences are.
  const double divergence = expected["divergence"];
  EXPECT_NEAR(binaryJensenShannon(pi.data(), p.data(), 8), divergence, 1e-6 * divergence);
}

TEST(Vectors, isolatedLeavesPayFromTheirBreakEvenRatioOn) {
  const std::vector<double> pi(8, 0.125);
  const nlohmann::json vectors = loadVectors();
  for (const auto& expected : vectors["breakEven"]) {
    SCOPED_TRACE(expected.dump());
    VectorTree tree(1);
    const auto root = tree.addInner(VectorTree::kNoParent);
    for (int i = 0; i < 8; ++i) {
      const double one = i < expected["positiveChildren"] ? 1.0 : 0.0;
      tree.addLeaf(root, 0.125, {1.0 - one, one});
    }
    const auto expands = [&](double ratio) {
      return findOptimalTree(tree, {{relevant("one", ratio, {1})}, 1.0}).expanded.front() != 0;
    };
    const double ratio = expected["ratio"];
    EXPECT_FALSE(expands(ratio * (1 - 1e-10)));
    EXPECT_TRUE(expands(ratio * (1 + 1e-10)));
    const auto found = findOptimalTree(tree, {{relevant("one", ratio, {1})}, 1.0});
    expectClose(natsToBits(found.full.information[0]), expected["divergenceBits"]);
  }
}

TEST(Vectors, entropyOfOneEighthInNatsAndBits) {
  const json expected = loadVectors()["entropyOfOneEighth"];
  expectClose(binaryEntropy(0.125), expected["nats"]);
  expectClose(natsToBits(binaryEntropy(0.125)), expected["bits"]);
  expectClose(kLn2 * expected["bits"].get<double>(), expected["nats"]);
}
