#include <semantic_abstraction/Abstraction.h>
#include <strict_files/OptionList.h>
#include <tree_abstraction/Information.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <utility>
#include <vector>

#include "AllAlphas.h"
#include "Classes.h"
#include "CsvTable.h"
#include "SemanticMapCompress.h"

namespace {

/** In blocks of 3.2 m. */
inline semantic_octree::AbstractionOptions optionsOf(
    std::vector<tree_abstraction::InformationTerm> terms, double alpha) {
  semantic_octree::AbstractionOptions options;
  options.weights.terms = std::move(terms);
  options.weights.alpha = alpha;
  options.blockSize = 3.2;
  return options;
}

namespace fs = std::filesystem;
using namespace semantic_octree;
using nlohmann::json;
using tree_abstraction::irrelevant;
using tree_abstraction::kLn2;
using tree_abstraction::relevant;

}  // namespace

TEST_F(SemanticMapCompress, takesAShareOfTheLeavesAndNeedsNoWeights) {
  for (const char* wanted : {"20%", "10%", ""}) {  // a tenth if nothing is said
    Words arguments = {mapFile(), "-f", "-o", output().string()};
    if (*wanted) arguments.insert(arguments.end(), {"--leaves", wanted});
    succeeded(runProgram("semantic-map-compress", arguments));
    const json report = json::parse(folder.read("out/report.json"));
    const json& all = report["solutions"][0];
    EXPECT_EQ(all["name"], "all-classes");
    const double share = all["leafRatio"]["known"], most = *wanted == '2' ? 0.2 : 0.1;
    EXPECT_LE(share, most);
    EXPECT_GT(share, 0.8 * most);
  }
}

TEST_F(SemanticMapCompress, writesTheOptimalTreesOfItsSolutions) {
  ASSERT_EQ(compress(kTwoSolutions).status, 0);
  SemanticOcTree map = loadTree(mapFile());
  setAbstraction(map, optionsOf({relevant("a", 1, {1}), irrelevant("b", 0.2, {3})}, 0.01));
  EXPECT_TRUE(loadTree((output() / "posts.semantic").string()) == Abstraction(map).compressedMap());
  dropAbstraction(map);
  setAbstraction(map, optionsOf({relevant("a", 1, {2, 3}), relevant("b", 0.5, {6}),
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
  setAbstraction(map, optionsOf(terms, 0.01));
  const AbstractionMeasures expected = Abstraction(map).measures();

  const json& posts = report["solutions"][0];
  EXPECT_EQ(posts["name"], "posts");
  EXPECT_EQ(posts["weights"], json({{"post", 1.0}, {"grass", -0.2}}));
  EXPECT_EQ(posts["alpha"], 0.01);
  for (const auto& [told, tree] : {std::pair(report["map"]["tree"], expected.full),
                                   std::pair(posts["tree"], expected.compressed)}) {
    EXPECT_EQ(told["knownLeaves"], tree.numKnownLeaves);
    EXPECT_EQ(told["allLeaves"], tree.numLeaves);
    EXPECT_NEAR(kLn2 * told["leafEntropy"].get<double>(), tree.leafEntropy, 1e-12);
  }
  EXPECT_NEAR(kLn2 * posts["objective"].get<double>(), expected.objective, 1e-12);
  EXPECT_EQ(posts["classes"].size(), K + 1u);
  for (std::size_t id = 0; id <= K; ++id) {
    const json& kept = posts["classes"][id == 0 ? "free_space" : kNames[id - 1]];
    EXPECT_NEAR(kLn2 * kept["full"].get<double>(), expected.full.information[id], 1e-12);
    EXPECT_NEAR(kLn2 * kept["kept"].get<double>(), expected.compressed.information[id], 1e-12);
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
  const auto table = csvTable(folder.read("out/report.csv"));
  ASSERT_EQ(table.size(), 3u);
  EXPECT_EQ(table[1].size(), table[0].size());
  EXPECT_EQ(table[2].size(), table[0].size());
  const auto column = std::find(table[0].begin(), table[0].end(), "/classes/wall, low/share");
  ASSERT_NE(column, table[0].end());
  EXPECT_NEAR(std::stod(table[2][static_cast<std::size_t>(column - table[0].begin())]),
              report["solutions"][1]["classes"]["wall, low"]["share"], 1e-6);
}

TEST_F(SemanticMapCompress, manyClassesAreMeasuredAsIfAlone) {
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
    dropAbstraction(map);
    setAbstraction(map, optionsOf(terms, 0.01));
    EXPECT_NEAR(classes["class " + std::to_string(id)]["share"],
                *Abstraction(map).measures().retention(terms.size() - 1), 1e-12)
        << id;
  }
}

TEST_F(SemanticMapCompress, aWantedSizeGivesTheLargestOptimalTreeWithin) {
  SemanticOcTree map = loadTree(mapFile());
  setAbstraction(
      map,
      optionsOf({relevant("a", 1, {1}), tree_abstraction::wholeClassVariable("b", 0.2, K)}, 0));
  Abstraction abstraction(map);
  const AllAlphas path(abstraction);
  const auto leavesWith = [&](const std::string& option, std::size_t wanted) {
    const json report = reportOf("{name: a, relevant: {post: 1}, everything: 0.2, block_size: 3.2}",
                                 {option, std::to_string(wanted)});
    return report["solutions"][0]["tree"]["knownLeaves"].get<double>();
  };
  const auto above = [&](double leaves) {
    return std::upper_bound(path.leaves.begin(), path.leaves.end(), leaves);
  };
  for (const std::size_t wanted : {500, 5000})
    EXPECT_EQ(leavesWith("--leaves", wanted), *(above(double(wanted)) - 1)) << wanted;
  for (const std::size_t wanted : {20000, 50000}) {
    const auto next = above(leavesWith("--bytes", wanted)) - path.leaves.begin();
    EXPECT_LE(fs::file_size(output() / "a.semantic"), wanted);
    abstraction.setAlpha(path.trees.alpha(static_cast<std::size_t>(next)));
    saveTree(abstraction.compressedMap(), (folder / "next.semantic").string());
    EXPECT_GT(fs::file_size(folder / "next.semantic"), wanted);
  }
}

TEST_F(SemanticMapCompress, curveTellsWhatTheTreesOfItsAlphasKeep) {
  const std::string weights =
      "{name: a, relevant: {post: 1}, irrelevant: {grass: 0.2}, alpha: 0.01, block_size: 3.2}";
  const json curve = reportOf(weights)["solutions"][0]["curve"];
  for (const std::size_t i : {std::size_t(0), curve.size() / 2, curve.size() - 1}) {
    const json& point = curve[i];
    const json tree =
        reportOf(weights, {"--alpha", strict_files::textOf(point["alpha"])})["solutions"][0];
    EXPECT_EQ(tree["tree"]["knownLeaves"], point["knownLeaves"]);
    EXPECT_NEAR(tree["classes"]["post"]["share"], point["relevantShare"], 1e-9);
    EXPECT_NEAR(tree["classes"]["grass"]["share"], point["irrelevantShare"], 1e-9);
  }
}

TEST_F(SemanticMapCompress, picturesAndFiguresShowSomething) {
  ASSERT_EQ(compress(kTwoSolutions).status, 0);
  for (const char* name :
       {"posts.top.png", "ground_and-cars.top.png", "maps.png", "retained.png", "curves.png"}) {
    const cv::Mat picture = cv::imread((output() / name).string(), cv::IMREAD_GRAYSCALE);
    ASSERT_FALSE(picture.empty()) << name;
    EXPECT_GT(picture.cols, 400) << name;
    EXPECT_GT(cv::countNonZero(picture < 200), 1000) << name;
  }
}

TEST_F(SemanticMapCompress, namesAreNoCommandsForGnuplot) {
  const auto table =
      tableOf({"post", "road'\"`touch x`", "100 %s", "@x {/Bold y}", "|touch x", "!touch x"});
  saveTree(smallMap(table), folder / "a'\n!touch x\n.semantic");
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  folder.write("weights.yaml",
               "{name: a, relevant: {post: 1, \"road'\\\"`touch x`\": 0.5}, alpha: 0.01}");
  for (const char* output : {"|touch x", "b'\n!touch x\n"}) {
    succeeded(runProgram("semantic-map-compress",
                         {"a'\n!touch x\n.semantic", "--weights", "weights.yaml", "-o", output}));
    EXPECT_FALSE(cv::imread(fs::path(output) / "retained.png").empty()) << output;
  }
  EXPECT_FALSE(fs::exists("x"));
  fs::current_path(before);
}

TEST_F(SemanticMapCompress, withoutGnuplotAllButTheFiguresIsWritten) {
  const std::string path = getenv("PATH");
  setenv("PATH", folder.path().c_str(), 1);
  const ProgramRun run = compress(kTwoSolutions);
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(run.status, 1);
  EXPECT_TRUE(contains(run.errors, "gnuplot-nox"));
  for (const char* name : {"posts.semantic", "posts.top.png", "maps.png", "report.json"})
    EXPECT_TRUE(fs::exists(output() / name)) << name;
  EXPECT_FALSE(fs::exists(output() / "retained.png"));
}

TEST_F(SemanticMapCompress, refusesWeightsAndSizesThatNoTreeHasAndMapsOfNothing) {
  const std::string weights = "{name: a, relevant: {post: 1}, alpha: 0.01, block_size: 3.2}";
  for (const auto& [options, parts] : std::vector<std::pair<Words, Words>>{
           {{"--leaves", "3"}, {"'a'", "3 leaves", "blocks"}},
           {{"--leaves", "10000000"}, {"'a'", "10000000 leaves", "only"}},
           {{"--bytes", "100"}, {"'a'", "100 bytes"}},
           {{"--alpha", "nan"}, {"alpha"}},
           {{"--leaves", "0%"}, {"--leaves is '0%'"}},
           {{"--leaves", "101%"}, {"--leaves is '101%'"}},
           {{"--leaves", "-5"}, {"--leaves"}},
           {{"--leaves", "500", "--bytes", "50000"}, {"--"}}})
    expectRefusal(compress(weights, options), parts);
  expectRefusalOf("{name: a, relevant: {rode: 1}, alpha: 0.1}",
                  {"weights.yaml:1", "'rode'", "did you mean 'road'?"});
  expectRefusalOf("{name: a, relevant: {road: 1}}", {"'a'", "no alpha"});
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
