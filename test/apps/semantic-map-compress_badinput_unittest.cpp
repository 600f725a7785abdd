#include "SemanticMapCompress.h"

namespace fs = std::filesystem;
using namespace semantic_octree;

TEST_F(SemanticMapCompress, refusesWeightsThatTheLibraryRefuses) {
  expectRefusalOf("{name: a, relevant: {rode: 1}, alpha: 0.1}",
                  {"weights.yaml:1", "'rode'", "did you mean 'road'?"});
  expectRefusalOf("{name: a, relevant: {road: 1}}", {"'a'", "no alpha"});
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
