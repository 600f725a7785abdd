#include <gtest/gtest.h>
#include <semantic_octree/Abstraction.h>
#include <semantic_octree/TreeFile.h>
#include <tree_abstraction/Information.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "../semantic_octree/SmallScans.h"
#include "RunProgram.h"
#include "TemporaryFolder.h"

namespace fs = std::filesystem;
using namespace semantic_octree;
using nlohmann::json;
using tree_abstraction::bitsToNats;
using tree_abstraction::irrelevant;
using tree_abstraction::relevant;

namespace {

constexpr int K = 6;
const std::vector<std::string> kNames = {"post", "road", "grass", "wall, low", "tree", "car"};

ClassTable namedClasses() {
  ClassTable table;
  for (int k = 0; k < K; ++k) table.add(kNames[k], {static_cast<std::uint8_t>(40 * k), 90, 120});
  return table;
}

SemanticOcTree smallMap(const ClassTable& table, int classes) {
  SemanticOcTree map(0.2, table);
  for (const PosedCloud& scan : scansOfSmallPlace(3, 3000, classes, 7))
    map.insert(scan.cloud, scan.T_map_sensor);
  return map;
}

const char* const kTwoSolutions = R"(
block_size: 3.2
solutions:
  - {name: posts, relevant: {post: 1}, irrelevant: {grass: 0.2}, alpha: 0.01}
  - name: ground_and-cars
    relevant:
      ground: {classes: [road, grass], weight: 1}
      car: 0.5
    everything: 0.1
    alpha: 0.02
)";

class SemanticMapCompress : public testing::Test {
 protected:
  void SetUp() override { saveTree(smallMap(namedClasses(), K), mapFile()); }

  std::string mapFile() const { return (folder / "map.semantic").string(); }
  fs::path output() const { return folder / "out"; }

  ProgramRun compress(const std::string& weights, std::vector<std::string> more = {}) const {
    const fs::path file = folder.write("weights.yaml", weights);
    std::vector<std::string> arguments = {mapFile(), "--weights", file.string(), "--output",
                                          output().string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram("semantic-map-compress", arguments);
  }
  json reportOf(const std::string& weights, const std::vector<std::string>& more = {}) const {
    const ProgramRun run = compress(weights, more);
    EXPECT_EQ(run.status, 0) << run.errors;
    return json::parse(folder.read("out/report.json"));
  }
  void expectRefusal(const ProgramRun& run, const std::vector<std::string>& parts) const {
    EXPECT_NE(run.status, 0);
    for (const std::string& part : parts)
      EXPECT_TRUE(contains(run.errors, part)) << part << " is not in: " << run.errors;
    EXPECT_FALSE(fs::exists(output()));
  }
  void expectRefusalOf(const std::string& solution, const std::vector<std::string>& parts) const {
    expectRefusal(compress(solution), parts);
  }

  TemporaryFolder folder;

  /** The map with the weights of kToSize. */
  SemanticOcTree mapToSize() const;
};

const char* const kToSize = "{name: a, relevant: {post: 1}, everything: 0.2, block_size: 3.2}";

AbstractionOptions optionsOf(std::vector<tree_abstraction::InformationTerm> terms, double alpha) {
  AbstractionOptions options;
  options.weights.terms = std::move(terms);
  options.weights.alpha = alpha;
  options.blockSize = 3.2;
  return options;
}

SemanticOcTree SemanticMapCompress::mapToSize() const {
  SemanticOcTree map = loadTree(mapFile());
  map.setAbstraction(
      optionsOf({relevant("a", 1, {1}), tree_abstraction::wholeClassVariable("b", 0.2, K)}, 0));
  return map;
}

}  // namespace

TEST_F(SemanticMapCompress, writesTheOptimalTreesOfItsSolutions) {
  ASSERT_EQ(compress(kTwoSolutions).status, 0);
  SemanticOcTree map = loadTree(mapFile());
  map.setAbstraction(optionsOf({relevant("a", 1, {1}), irrelevant("b", 0.2, {3})}, 0.01));
  EXPECT_TRUE(loadTree((output() / "posts.semantic").string()) == Abstraction(map).compressedMap());
  map.dropAbstraction();
  map.setAbstraction(optionsOf({relevant("a", 1, {2, 3}), relevant("b", 0.5, {6}),
                                tree_abstraction::wholeClassVariable("c", 0.1, K)},
                               0.02));
  EXPECT_TRUE(loadTree((output() / "ground_and-cars.semantic").string()) ==
              Abstraction(map).compressedMap());
}

TEST_F(SemanticMapCompress, reportHoldsTheMeasuresOfTheTreesThatAreWritten) {
  const json report = reportOf(kTwoSolutions);
  SemanticOcTree map = loadTree(mapFile());
  std::vector<tree_abstraction::InformationTerm> terms;
  for (int id = 0; id <= K; ++id) terms.push_back({std::to_string(id), 0, {{id}}});
  terms[1].weight = 1;
  terms[3].weight = -0.2;
  map.setAbstraction(optionsOf(terms, 0.01));
  const AbstractionMeasures expected = Abstraction(map).measures();

  const json& posts = report["solutions"][0];
  EXPECT_EQ(posts["name"], "posts");
  EXPECT_EQ(posts["weights"], json({{"post", 1.0}, {"grass", -0.2}}));
  EXPECT_EQ(posts["alpha"], 0.01);
  EXPECT_EQ(report["map"]["tree"]["knownLeaves"], expected.full.numKnownLeaves);
  EXPECT_EQ(report["map"]["tree"]["allLeaves"], expected.full.numLeaves);
  EXPECT_EQ(posts["tree"]["knownLeaves"], expected.compressed.numKnownLeaves);
  EXPECT_EQ(posts["tree"]["allLeaves"], expected.compressed.numLeaves);
  EXPECT_NEAR(bitsToNats(posts["tree"]["leafEntropy"]), expected.compressed.leafEntropy, 1e-12);
  EXPECT_NEAR(bitsToNats(posts["objective"]), expected.objective, 1e-12);
  EXPECT_EQ(posts["classes"].size(), K + 1u);
  for (std::size_t id = 0; id <= K; ++id) {
    const json& kept = posts["classes"][id == 0 ? "free_space" : kNames[id - 1]];
    EXPECT_NEAR(bitsToNats(kept["full"]), expected.full.information[id], 1e-12);
    EXPECT_NEAR(bitsToNats(kept["kept"]), expected.compressed.information[id], 1e-12);
    EXPECT_NEAR(kept["share"], *expected.retention(id), 1e-12);
  }
  for (const json& solution : report["solutions"]) {
    const fs::path file = output() / (solution["name"].get<std::string>() + ".semantic");
    EXPECT_EQ(solution["fileBytes"], fs::file_size(file));
    const auto leaves = loadTree(file.string()).getNumLeafNodes();
    EXPECT_EQ(solution["tree"]["knownLeaves"], leaves);
    EXPECT_DOUBLE_EQ(solution["leafRatio"]["known"],
                     double(leaves) / double(loadTree(mapFile()).getNumLeafNodes()));
  }
  EXPECT_EQ(report["solutions"][1]["groups"].size(), 2u);
}

TEST_F(SemanticMapCompress, csvHoldsALineForEachSolutionWithAValueForEachColumn) {
  const json report = reportOf(kTwoSolutions);
  const std::string csv = folder.read("out/report.csv");
  std::vector<std::vector<std::string>> table(1, std::vector<std::string>(1));
  bool inQuotes = false;
  for (const char c : csv) {
    if (c == '"')
      inQuotes = !inQuotes;
    else if (c == ',' && !inQuotes)
      table.back().emplace_back();
    else if (c == '\n')
      table.emplace_back(1);
    else
      table.back().back() += c;
  }
  ASSERT_EQ(table.size(), 4u);  // the last is what follows the last line break
  EXPECT_EQ(table[1].size(), table[0].size());
  EXPECT_EQ(table[2].size(), table[0].size());
  const auto column = std::find(table[0].begin(), table[0].end(), "wall, low retained");
  ASSERT_NE(column, table[0].end());
  EXPECT_NEAR(std::stod(table[2][static_cast<std::size_t>(column - table[0].begin())]),
              report["solutions"][1]["classes"]["wall, low"]["share"], 1e-6);
}

TEST_F(SemanticMapCompress, classesBeyondTheFirstBatchAreMeasuredAsIfAlone) {
  constexpr int kMany = 60;
  saveTree(smallMap(numberedClasses(kMany), kMany), mapFile());
  const json report =
      reportOf("{name: a, relevant: {class 1: 1, class 55: 2}, alpha: 0.01, block_size: 3.2}");
  const json& classes = report["solutions"][0]["classes"];
  ASSERT_EQ(classes.size(), kMany + 1u);
  SemanticOcTree map = loadTree(mapFile());
  for (const int id : {2, 24, 25, 27, 28, 52, 53, 54, 55, 60}) {
    std::vector<tree_abstraction::InformationTerm> terms = {relevant("1", 1, {1}),
                                                            relevant("55", 2, {55})};
    if (id != 55) terms.push_back(relevant("x", 0, {id}));
    map.dropAbstraction();
    map.setAbstraction(optionsOf(terms, 0.01));
    EXPECT_NEAR(classes["class " + std::to_string(id)]["share"],
                *Abstraction(map).measures().retention(terms.size() - 1), 1e-12)
        << id;
  }
}

TEST_F(SemanticMapCompress, strongerPenaltiesKeepLess) {
  const json report = reportOf(R"(
block_size: 3.2
solutions:
  - {name: none, relevant: {post: 1}, alpha: 0.002}
  - {name: weak, relevant: {post: 1}, irrelevant: {road: 0.3}, alpha: 0.002}
  - {name: strong, relevant: {post: 1}, irrelevant: {road: 2}, alpha: 0.002}
)");
  const auto kept = [&](int i) {
    return report["solutions"][i]["classes"]["road"]["share"].get<double>();
  };
  EXPECT_GT(kept(0), kept(1));
  EXPECT_GT(kept(1), kept(2));
}

TEST_F(SemanticMapCompress, aWantedNumberOfLeavesGivesTheLargestOptimalTreeWithin) {
  SemanticOcTree map = mapToSize();
  const Abstraction::Path path = Abstraction(map).alphaPath();
  const auto totals = path.trees.totals(path.addedLeaves, double(path.numRoots));
  for (const std::size_t wanted : {500, 2000, 5000}) {
    const json report = reportOf(kToSize, {"--leaves", std::to_string(wanted)});
    const auto beyond = std::upper_bound(totals.begin(), totals.end(), double(wanted));
    EXPECT_EQ(report["solutions"][0]["tree"]["knownLeaves"], *(beyond - 1)) << wanted;
  }
}

TEST_F(SemanticMapCompress, aWantedNumberOfBytesIsKeptAndTheNextLargerTreeExceedsIt) {
  SemanticOcTree map = mapToSize();
  Abstraction abstraction(map);
  const Abstraction::Path path = abstraction.alphaPath();
  const auto totals = path.trees.totals(path.addedLeaves, double(path.numRoots));
  for (const std::size_t wanted : {20000, 50000}) {
    const json report = reportOf(kToSize, {"--bytes", std::to_string(wanted)});
    const json& solution = report["solutions"][0];
    EXPECT_LE(fs::file_size(output() / "a.semantic"), wanted);
    const auto next = std::upper_bound(totals.begin(), totals.end(),
                                       solution["tree"]["knownLeaves"].get<double>());
    abstraction.setAlpha(path.trees.alpha(static_cast<std::size_t>(next - totals.begin())));
    saveTree(abstraction.compressedMap(), (folder / "next.semantic").string());
    EXPECT_GT(fs::file_size(folder / "next.semantic"), wanted);
  }
}

TEST_F(SemanticMapCompress, theCommandLinesAlphaGoesBeforeTheFiles) {
  const json report = reportOf(kTwoSolutions, {"--alpha", "0.05"});
  for (const json& solution : report["solutions"]) EXPECT_EQ(solution["alpha"], 0.05);
}

TEST_F(SemanticMapCompress, curveLeadsFromTheBlocksToAlphaZeroThroughTheChosenTree) {
  const json report = reportOf(kTwoSolutions);
  for (const json& solution : report["solutions"]) {
    const json& curve = solution["curve"];
    ASSERT_GT(curve.size(), 10u);
    for (std::size_t i = 1; i < curve.size(); ++i) {
      EXPECT_GT(curve[i]["knownLeaves"], curve[i - 1]["knownLeaves"]);
      EXPECT_LT(curve[i]["alpha"], curve[i - 1]["alpha"]);
      if (solution["name"] == "posts") continue;  // penalties may take information away
      EXPECT_GT(curve[i]["relevantShare"], curve[i - 1]["relevantShare"]);
    }
    for (const json& point : curve) {
      const json &leaves = point["knownLeaves"], &chosen = solution["tree"]["knownLeaves"];
      EXPECT_TRUE(point["alpha"] > solution["alpha"] ? leaves <= chosen : leaves >= chosen);
    }
    EXPECT_EQ(curve[0]["irrelevantShare"].is_null(), solution["name"] != "posts");
  }
}

TEST_F(SemanticMapCompress, spaceOptionsAndRegionsReachTheSearch) {
  using O = AbstractionOptions;
  const auto expectSame = [&](const std::string& yaml, const std::function<void(O&)>& change) {
    ASSERT_EQ(compress("{name: a, relevant: {post: 1}, alpha: 0.0005, " + yaml + "}").status, 0);
    O options = optionsOf({relevant("a", 1, {1})}, 0.0005);
    options.blockSize = O().blockSize;
    change(options);
    SemanticOcTree map = loadTree(mapFile());
    map.setAbstraction(options);
    EXPECT_TRUE(loadTree((output() / "a.semantic").string()) == Abstraction(map).compressedMap())
        << yaml;
  };
  expectSame("block_size: 1.6", [](O& o) { o.blockSize = 1.6; });
  expectSame("block_size: 0, frame: charged", [](O& o) {
    o.blockSize = 0;
    o.frame = O::Frame::Charged;
  });
  expectSame("unknown: uniform", [](O& o) { o.unknown = O::Unknown::Uniform; });
  expectSame("unknown: prior", [](O& o) { o.unknown = O::Unknown::Prior; });
  expectSame("unknown_weight: 0.3", [](O& o) { o.unknownWeight = 0.3; });
  expectSame(
      "regions: [{box: [[0, -1, -2], [1, 2, 3]], weight: 5}, {sphere: [1, 2, 0], radius: 2, weight:"
      " 0}, {corridor: [[-3, 0, 0], [0, -3, 1]], radius: 1.5, weight: 3}]",
      [](O& o) {
        o.regions = {{Region::Shape::Box, {0, -1, -2}, {1, 2, 3}, 0, 5},
                     {Region::Shape::Sphere, {1, 2, 0}, {0, 0, 0}, 2, 0},
                     {Region::Shape::Corridor, {-3, 0, 0}, {0, -3, 1}, 1.5, 3}};
      });
}

TEST_F(SemanticMapCompress, picturesAndFiguresShowSomething) {
  ASSERT_EQ(compress(kTwoSolutions).status, 0);
  for (const char* name : {"posts.top.png", "ground_and-cars.top.png", "maps.png", "retained.png",
                           "weights.png", "curves.png"}) {
    const cv::Mat picture = cv::imread((output() / name).string(), cv::IMREAD_GRAYSCALE);
    ASSERT_FALSE(picture.empty()) << name;
    EXPECT_GT(picture.cols, 400) << name;
    EXPECT_GT(cv::countNonZero(picture < 200), 1000) << name;
  }
}

TEST_F(SemanticMapCompress, withoutGnuplotAllButTheFiguresIsWritten) {
  const std::string path = getenv("PATH");
  setenv("PATH", folder.path().c_str(), 1);
  const ProgramRun run = compress(kTwoSolutions);
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(run.status, 1);
  EXPECT_TRUE(contains(run.errors, "gnuplot-nox")) << run.errors;
  for (const char* name : {"posts.semantic", "posts.top.png", "maps.png", "report.json"})
    EXPECT_TRUE(fs::exists(output() / name)) << name;
  EXPECT_FALSE(fs::exists(output() / "retained.png"));
}

TEST_F(SemanticMapCompress, refusesClassesThatTheMapDoesNotHave) {
  expectRefusalOf("{name: a, relevant: {rode: 1}, alpha: 0.1}",
                  {"weights.yaml:1", "'rode'", "road, grass"});
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
  refuse("unknown: none", {"weights.yaml:4", "own_class, prior, uniform", "'none'"});
  refuse("frame: paid", {"charged, free", "'paid'"});
  refuse("unknown_weight: 1.5", {"unknown_weight", "0 to 1"});
  refuse("regions: [{weight: 2}]", {"box, sphere, corridor"});
  refuse("regions: [{sphere: [0, 0, 0], weight: 2}]", {"radius"});
  refuse("regions: [{sphere: [0, 0, 0], radius: -1, weight: 2}]", {"radius"});
  refuse("regions: [{sphere: [0, 0], radius: 1, weight: 2}]", {"[x, y, z]"});
  refuse("regions: [{box: [[0, 0, 0], [1, 1, -1]], weight: 2}]", {"lowest corner first"});
  refuse("regions: [{box: [[0, 0, 0], [1, 1, 1]]}]", {"'weight'"});
  refuse("regions: [{box: [[0, 0, 0], [1, 1, 1]], weight: -1}]", {"weight of a region"});
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
