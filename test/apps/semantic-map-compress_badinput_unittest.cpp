#include "SemanticMapCompress.h"

namespace fs = std::filesystem;
using namespace semantic_octree;

TEST_F(SemanticMapCompress, refusesClassesThatTheMapDoesNotHave) {
  expectRefusalOf("{name: a, relevant: {rode: 1}, alpha: 0.1}",
                  {"weights.yaml:1", "'rode'", "did you mean 'road'?"});
  expectRefusalOf("{name: a, irrelevant: {rode: 1}, alpha: 0.1}", {"'rode'"});
  expectRefusalOf("{name: a, relevant: {g: {classes: [road, cra], weight: 1}}, alpha: 0.1}",
                  {"'cra'"});
}

TEST_F(SemanticMapCompress, refusesWeightsThatAreNoNumberFromZeroOn) {
  for (const std::string weight : {"-1", ".nan", "nan", "much", "[1]", ""})
    expectRefusalOf("{name: a, relevant: {road: " + weight + "}, alpha: 0.1}",
                    {"weights.yaml:1", "weight of 'road'"});
  for (const std::string weight : {"-0.1", ".nan"}) {
    expectRefusalOf("{name: a, irrelevant: {road: " + weight + "}, alpha: 0.1}", {"'road'"});
    expectRefusalOf("{name: a, relevant: {g: {classes: [car], weight: " + weight + "}}, alpha: 1}",
                    {"weight of 'g'"});
    expectRefusalOf("{name: a, everything: " + weight + ", alpha: 0.1}", {"everything"});
    expectRefusalOf("{name: a, relevant: {road: 1}, alpha: " + weight + "}", {"alpha"});
    expectRefusalOf("{name: a, relevant: {road: 1}, alpha: 1, block_size: " + weight + "}",
                    {"block_size"});
  }
}

TEST_F(SemanticMapCompress, refusesClassesThatAreBothRelevantAndIrrelevant) {
  expectRefusalOf("{name: a, relevant: {road: 1}, irrelevant: {road: 1}, alpha: 0.1}",
                  {"'road'", "both relevant and irrelevant"});
  expectRefusalOf(
      "{name: a, relevant: {road: 1}, irrelevant: {g: {classes: [car, road], weight: 1}}, alpha: "
      "1}",
      {"'road'", "both relevant", "'g'"});
}

TEST_F(SemanticMapCompress, refusesUnknownRepeatedAndMissingKeys) {
  expectRefusalOf("name: a\nrelevent: {road: 1}\nalpha: 0.1\n", {"weights.yaml:2", "'relevent'"});
  expectRefusalOf("solutions:\n - {name: a, relevant: {road: 1}, alfa: 0.1}\n",
                  {"weights.yaml:2", "'alfa'"});
  expectRefusalOf("{solutions: [{name: a, relevant: {road: 1}, alpha: 1}], alpha: 1}", {"'alpha'"});
  expectRefusalOf("{name: a, relevant: {road: 1, road: 2}, alpha: 0.1}", {"'road' twice"});
  expectRefusalOf("{name: a, relevant: {g: {classes: [car, car], weight: 1}}, alpha: 0.1}",
                  {"'car' twice"});
  expectRefusalOf("{name: a, relevant: {g: {class: [car], weight: 1}}, alpha: 0.1}", {"'class'"});
  expectRefusalOf("{name: a, relevant: {g: {weight: 1}}, alpha: 0.1}", {"'classes'"});
  expectRefusalOf("{name: a, relevant: {g: {classes: [car]}}, alpha: 0.1}", {"'weight'"});
  expectRefusalOf("{name: a, relevant: {car: {classes: [car], weight: 1}}, alpha: 1}", {"'car'"});
  expectRefusalOf("{relevant: {road: 1}, alpha: 0.1}", {"'name'"});
  expectRefusalOf("{name: a, alpha: 0.1}", {"weighs nothing"});
  expectRefusalOf("{name: a, relevant: {road: 1}}", {"'a'", "no alpha"});
}

TEST_F(SemanticMapCompress, refusesBadNamesAndSyntax) {
  for (const std::string name : {"''", "../a", "a/b", "a.b", "a b"})
    expectRefusalOf("{name: " + name + ", relevant: {road: 1}, alpha: 0.1}", {"name"});
  expectRefusalOf(
      "solutions:\n - {name: a, everything: 1, alpha: 1}\n - {name: a, everything: 1, alpha: 1}\n",
      {"weights.yaml:3", "two solutions called 'a'"});
  expectRefusalOf("name: [a\nrelevant: {road: 1}", {"weights.yaml"});
  expectRefusalOf("- 1\n", {"weights.yaml:1", "key: value"});
  expectRefusalOf("", {"weights.yaml", "key: value"});
  expectRefusalOf("solutions: []", {"solutions", "list"});
}

TEST_F(SemanticMapCompress, refusesBadSpaceOptions) {
  const auto refuse = [&](const std::string& options, const std::vector<std::string>& parts) {
    expectRefusalOf("name: a\nrelevant: {road: 1}\nalpha: 0.1\n" + options + "\n", parts);
  };
  refuse("unknown: none", {"weights.yaml:4", "own_class, uniform", "'none'"});
  refuse("regions: [cube 2]", {"weights.yaml:4", "box, sphere or corridor"});
  refuse("regions: [sphere 0 0 0 2]", {"'sphere 0 0 0 2'", "the numbers of this shape"});
  refuse("regions: [sphere 0 0 0 -1 2]", {"radius"});
  refuse("regions: [box 0 0 0 1 1 -1 2]", {"lowest corner first"});
  refuse("regions: [box 0 0 0 1 1 1 -1]", {"weight of a region"});
}

TEST_F(SemanticMapCompress, refusesSizesThatNoTreeHas) {
  const std::string weights = "{name: a, relevant: {post: 1}, alpha: 0.01, block_size: 3.2}";
  expectRefusal(compress(weights, {"--leaves", "3"}), {"'a'", "3 leaves", "blocks"});
  expectRefusal(compress(weights, {"--leaves", "10000000"}), {"'a'", "10000000 leaves", "only"});
  expectRefusal(compress(weights, {"--bytes", "100"}), {"'a'", "100 bytes"});
  for (const char* wrong : {"-1", "nan", "x"})
    expectRefusal(compress(weights, {"--alpha", wrong}), {"alpha"});
  expectRefusal(compress(weights, {"--leaves", "-5"}), {"--leaves"});
  expectRefusal(compress(weights, {"--leaves", "500", "--bytes", "50000"}), {"--"});
}

TEST_F(SemanticMapCompress, refusesMapsThatAreMissingDamagedOrEmpty) {
  fs::remove(mapFile());
  expectRefusalOf(kTwoSolutions, {"map.semantic"});
  folder.write("map.semantic", "no map");
  expectRefusalOf(kTwoSolutions, {"map.semantic"});
  saveTree(SemanticOcTree(0.2, namedClasses()), mapFile());
  expectRefusalOf(kTwoSolutions, {"empty"});
}

TEST_F(SemanticMapCompress, whatWasThereStaysIfAnythingFails) {
  folder.write("out/report.json", "of before");
  folder.write("out/good.semantic", "of before");
  EXPECT_EQ(compress("solutions:\n - {name: good, everything: 1, alpha: 1}\n"
                     " - {name: bad, everything: 1}\n")
                .status,
            1);
  EXPECT_EQ(folder.read("out/report.json"), "of before");
  EXPECT_EQ(folder.read("out/good.semantic"), "of before");
  EXPECT_EQ(std::distance(fs::directory_iterator(output()), fs::directory_iterator()), 2);
}
