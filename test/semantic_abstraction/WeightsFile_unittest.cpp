#include <gtest/gtest.h>
#include <semantic_abstraction/AbstractionOptions.h>

#include "Classes.h"
#include "TemporaryFolder.h"

using semantic_octree::AbstractionOptions;
using semantic_octree::loadWeights;
using semantic_types::ClassTable;

namespace {

ClassTable roadTreeWall() { return tableOf({"road", "tree", "wall"}); }

/** What a file with one solution says. */
AbstractionOptions ofFile(const std::string& text) {
  const TemporaryFolder folder;
  return loadWeights(folder.write("w.yaml", "name: a\n" + text), roadTreeWall(), -1).at(0);
}

AbstractionOptions someText() {
  AbstractionOptions text;
  text.relevant = "road: 1, tree: 0.5";
  return text;
}

void expectSame(const AbstractionOptions& a, const AbstractionOptions& b) {
  EXPECT_EQ(a.blockSize, b.blockSize);
  EXPECT_EQ(a.unknown, b.unknown);
  EXPECT_EQ(a.frame, b.frame);
  EXPECT_EQ(a.weights.alpha, b.weights.alpha);
  ASSERT_EQ(a.weights.terms.size(), b.weights.terms.size());
  for (std::size_t i = 0; i < a.weights.terms.size(); ++i) {
    EXPECT_EQ(a.weights.terms[i].weight, b.weights.terms[i].weight);
    EXPECT_EQ(a.weights.terms[i].groups, b.weights.terms[i].groups);
  }
  ASSERT_EQ(a.regions.size(), b.regions.size());
  for (std::size_t i = 0; i < a.regions.size(); ++i) {
    EXPECT_EQ(a.regions[i].shape, b.regions[i].shape);
    EXPECT_EQ(a.regions[i].a, b.regions[i].a);
    EXPECT_EQ(a.regions[i].b, b.regions[i].b);
    EXPECT_EQ(a.regions[i].radius, b.regions[i].radius);
    EXPECT_EQ(a.regions[i].weight, b.regions[i].weight);
  }
}

}  // namespace

TEST(WeightsFile, linesOfTextAndYamlSayTheSame) {
  AbstractionOptions text;
  text.relevant = "road: 1, tree+free_space: 0.5";
  text.irrelevant = "wall: 0.25";
  text.everything = 0.1;
  text.weights.alpha = 0.03;
  text.blockSize = 1.6;
  text.unknown = AbstractionOptions::Unknown::Uniform;
  text.regionTexts = "box 0 0 -1 10 5 3 5; sphere 4 2 0 3 2; corridor 0 0 0 20 0 0 3 4";
  const AbstractionOptions options = text.forClasses(roadTreeWall());
  expectSame(options,
             ofFile("relevant: {road: 1, soft: {classes: [tree, free_space], weight: 0.5}}\n"
                    "irrelevant: {wall: 0.25}\neverything: 0.1\nalpha: 0.03\n"
                    "block_size: 1.6\nunknown: uniform\n"
                    "regions:\n"
                    " - box 0 0 -1 10 5 3 5\n - sphere 4 2 0 3 2\n - corridor 0 0 0 20 0 0 3 4\n"));
  EXPECT_EQ(options.weights.terms[1].groups, (std::vector<std::vector<int>>{{0, 2}}));
  EXPECT_EQ(options.weights.terms[2].weight, -0.25);
  EXPECT_EQ(options.regions[2].radius, 3);
  EXPECT_EQ(options.regions[2].text(), "corridor 0 0 0 20 0 0 3 4");
}

TEST(WeightsFile, linesOfTextAreCheckedWithoutClasses) {
  const auto refusal = [](auto change) {
    AbstractionOptions text = someText();
    change(text);
    return errorOf([&] { text.validate(); });
  };
  EXPECT_EQ(refusal([](AbstractionOptions&) {}), "");
  EXPECT_TRUE(contains(refusal([](auto& t) { t.relevant = "road"; }), "relevant: 'road'"));
  EXPECT_TRUE(contains(refusal([](auto& t) { t.irrelevant = "road: inf"; }), "irrelevant"));
  EXPECT_TRUE(contains(refusal([](auto& t) { t.weights.alpha = -1; }), "alpha is -1"));
  EXPECT_TRUE(contains(refusal([](auto& t) { t.regionTexts = "sphere 0 0 0 -1 2"; }), "radius"));
  EXPECT_TRUE(contains(refusal([](auto& t) { t.regionTexts = "cube 1"; }), "cube 1"));
}

TEST(WeightsFile, aClassCannotBeBothKeptAndDropped) {
  AbstractionOptions text = someText();
  text.irrelevant = "wall+road: 1";
  EXPECT_TRUE(contains(errorOf([&] { text.forClasses(roadTreeWall()); }),
                       "class 'road' is both relevant ('road') and irrelevant ('wall+road')"));
  text.irrelevant = "road: 1";
  EXPECT_TRUE(contains(errorOf([&] { text.forClasses(roadTreeWall()); }),
                       "irrelevant: 'road' is both relevant and irrelevant"));
  text.irrelevant = "wall: 1, wall: 2";
  EXPECT_TRUE(contains(errorOf([&] { text.forClasses(roadTreeWall()); }), "'wall' twice"));
}

TEST(WeightsFile, badFilesAreRefusedWithTheirLine) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& text) {
    const auto file = folder.write("weights.yaml", text);
    return errorOf([&] { loadWeights(file, roadTreeWall()); });
  };
  const std::string some = "name: a\nrelevant: {road: 1}\nalpha: 0.1\n";
  EXPECT_EQ(refusal(some), "");
  std::vector<std::pair<std::string, std::string>> cases = {
      {"{name: a, relevant: {rode: 1}}", "weights.yaml:1: unknown class 'rode'"},
      {"{name: a, irrelevant: {rode: 1}}", "'rode'"},
      {"{name: a, relevant: {g: {classes: [road, cra], weight: 1}}}", "'cra'"},
      {"{name: a, relevant: {road: 1}, irrelevant: {road: 1}}", "both relevant and irrelevant"},
      {"{name: a, relevant: {road: 1}, irrelevant: {g: {classes: [wall, road], weight: 1}}}",
       "both relevant"},
      {"name: a\nrelevent: {road: 1}\nalpha: 0.1\n", "weights.yaml:2: unknown key 'relevent'"},
      {"solutions:\n - {name: a, relevant: {road: 1}, alfa: 1}\n", "weights.yaml:2: unknown key"},
      {"{solutions: [{name: a, relevant: {road: 1}, alpha: 1}], alpha: 1}", "'alpha'"},
      {"{name: a, relevant: {road: 1, road: 2}}", "'road' twice"},
      {"{name: a, relevant: {g: {classes: [wall, wall], weight: 1}}}", "'wall' twice"},
      {"{name: a, relevant: {g: {class: [wall], weight: 1}}}", "'class'"},
      {"{name: a, relevant: {g: {weight: 1}}}", "'classes'"},
      {"{name: a, relevant: {g: {classes: [wall]}}}", "'weight'"},
      {"{name: a, relevant: {wall: {classes: [wall], weight: 1}}}", "'wall'"},
      {"{relevant: {road: 1}}", "'name'"},
      {"{name: a, alpha: 0.1}", "weighs nothing"},
      {"solutions:\n - {name: a, everything: 1}\n - {name: a, everything: 1}\n",
       "weights.yaml:3: name: two solutions called 'a'"},
      {"name: [a\nrelevant: {road: 1}", "weights.yaml"},
      {"- 1\n", "weights.yaml:1: expected 'key: value'"},
      {"", "key: value"},
      {"solutions: []", "list"},
      {some + "unknown: none", "weights.yaml:4: "},
      {some + "frame: free", "weights.yaml:4: unknown key 'frame'"},
      {some + "regions: [cube 2]", "box, sphere or corridor"},
      {some + "regions: [sphere 0 0 0 2]", "the numbers of this shape"},
      {some + "regions: [sphere 0 0 0 -1 2]", "radius"},
      {some + "regions: [box 0 0 0 1 1 -1 2]", "lowest corner first"},
      {some + "regions: [box 0 0 0 1 1 1 -1]", "weight of a region"}};
  for (const std::string bad : {"-1", ".nan", "much", "[1]", ""}) {
    cases.emplace_back("{name: a, relevant: {road: " + bad + "}}", "weight of 'road'");
    cases.emplace_back("{name: a, relevant: {g: {classes: [wall], weight: " + bad + "}}}", "'g'");
    cases.emplace_back("{name: a, everything: " + bad + "}", "everything");
    cases.emplace_back("{name: a, everything: 1, alpha: " + bad + "}", "alpha");
    if (bad != "[1]")
      cases.emplace_back("{name: a, everything: 1, block_size: " + bad + "}", "block_size");
  }
  for (const std::string name : {"''", "../a", "a/b", "a.b", "a b"})
    cases.emplace_back("{name: " + name + ", relevant: {road: 1}}", "name");
  for (const auto& [text, words] : cases)
    EXPECT_TRUE(contains(refusal(text), "weights.yaml") && contains(refusal(text), words))
        << text << '\n'
        << refusal(text);
}

TEST(TermCatalog, hasClassesFirstAndEachGroupOnce) {
  const TemporaryFolder folder;
  const auto file = loadWeights(
      folder.write("w.yaml",
                   "solutions:\n"
                   " - {name: a, relevant: {g: {classes: [road, tree], weight: 1}, wall: 2}}\n"
                   " - {name: b, irrelevant: {h: {classes: [tree, road], weight: 3}}}\n"),
      roadTreeWall());
  const semantic_octree::TermCatalog catalog(roadTreeWall(), file);
  ASSERT_EQ(catalog.size(), 5u);
  EXPECT_EQ(catalog.name(0), "free_space");
  EXPECT_EQ(catalog.name(3), "wall");
  EXPECT_EQ(catalog.name(4), "g");
  EXPECT_EQ(catalog.order(), (std::vector<std::size_t>{3, 4, 0, 1, 2}));
  EXPECT_EQ(catalog.weights(file[0]), (std::vector<double>{2, 1, 0, 0, 0}));
  EXPECT_EQ(catalog.weights(file[1]), (std::vector<double>{0, -3, 0, 0, 0}));
}
