#include <map_folders/MapFolder.h>
#include <map_operations/MapOperations.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <semantic_types/ClassTable.h>
#include <strict_files/StrictYaml.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>

#include "ExportFixture.h"

using semantic_octree::CellState;
using semantic_octree::SemanticOcTree;

namespace {

class SemanticMapEdit : public MapTool {
 protected:
  ProgramRun edit(const std::string& in, const std::string& out, const Words& options = {}) const {
    return runProgram("semantic-map-edit", joined({path(in), "-o", path(out)}, options));
  }
  SemanticOcTree edited(const Words& options, const std::string& in = "map.semantic") const {
    succeeded(edit(in, "out.semantic", joined(options, {"-f"})));
    return semantic_octree::loadMap(path("out.semantic"));
  }
};

TEST_F(SemanticMapEdit, timePassesForWhatHasAHalfLife) {
  expectRefusal(edit("map.semantic", "aged.semantic", {"--decay", "10"}),
                {"has a half-life; --half-lives gives them"});
  EXPECT_FALSE(std::filesystem::exists(path("aged.semantic")));

  folder.write("half-lives.yaml",
               "classes:\n - {id: 1, name: " + strict_files::yamlText(map.classes().name(1)) +
                   ", color: [0, 0, 0], half_life: 4}\n");
  const SemanticOcTree aged = edited({"--half-lives", path("half-lives.yaml"), "--decay", "6.5"});
  SemanticOcTree expected = map;
  expected.setHalfLives(semantic_types::loadClassTable(path("half-lives.yaml")));
  expected.age(6.5);
  EXPECT_TRUE(aged == expected);
  EXPECT_FALSE(aged == map);
  EXPECT_DOUBLE_EQ(aged.clock(), 6.5);
  saveTree(aged, path("aged.semantic"));
  expected.age(100);
  EXPECT_TRUE(edited({"--decay", "100"}, "aged.semantic") == expected);
}

TEST_F(SemanticMapEdit, doesWhatTheLibraryDoes) {
  Eigen::Isometry3d pose(Eigen::Translation3d(1, 2, 0.4));
  pose.rotate(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(edited({"--pose", "1,2,0.4,90,0,0"}) == semantic_octree::moved(map, pose));
  const SemanticOcTree corner =
      semantic_octree::cropped(map, {Eigen::Vector3d(-3, -2, -1), Eigen::Vector3d(4, 1, 2)});
  EXPECT_TRUE(edited({"--box", "-3,-2,-1,4,1,2"}) == corner);
  EXPECT_TRUE(edited({"--box", "-3", "-2", "-1", "4", "1", "2"}) == corner);
}

TEST_F(SemanticMapEdit, tilesAreAFolderWithTheMapInIt) {
  // Free space in leaves of 1.6 m, as large as tiles, with a post in it.
  octomap::OcTree free(0.2);
  for (float x = -1.5f; x < 3.2f; x += 0.2f)
    for (float y = -1.5f; y < 1.6f; y += 0.2f)
      for (float z = 0.1f; z < 1.6f; z += 0.2f) free.setNodeValue(x, y, z, x == y ? 1.f : -1.f);
  free.updateInnerOccupancy();
  free.prune();
  saveTree(semantic_octree::fromOcTree(free, coloredClasses()), path("sure.semantic"));
  for (const char* name : {"sure", "map"}) {
    ASSERT_EQ(edit(std::string(name) + ".semantic", name, {"--tiles", "1.6"}).status, 0);
    EXPECT_TRUE(semantic_octree::loadMap(path(name)) ==
                semantic_octree::loadMap(path(std::string(name) + ".semantic")));
  }
  // Others, that have no library, know from the index where something is.
  const YAML::Node index = YAML::LoadFile(path("sure/index.yaml"));
  std::set<std::array<int, 3>> cubes;
  for (const YAML::Node& tile : index["tiles"]) cubes.insert(tile["at"].as<std::array<int, 3>>());
  EXPECT_GT(index["leaves"].size(), 0u);
  for (const YAML::Node& leaf : index["leaves"]) {
    EXPECT_EQ(leaf["tiles"].as<int>(), 1);
    EXPECT_TRUE(cubes.insert(leaf["at"].as<std::array<int, 3>>()).second);
  }
  std::set<std::array<int, 3>> expected;
  for (auto leaf = free.begin_leafs(); leaf != free.end_leafs(); ++leaf)
    expected.insert({int(std::floor(leaf.getX() / 1.6)), int(std::floor(leaf.getY() / 1.6)),
                     int(std::floor(leaf.getZ() / 1.6))});
  EXPECT_EQ(cubes, expected);
}

TEST_F(SemanticMapEdit, tilesAreNotWrittenOverUnlessThatIsWanted) {
  const Words all = {"--tiles", "102.4"}, box = {"--box", "0", "0", "0", "1", "1", "1"};
  succeeded(edit("map.semantic", "tiles", all));
  expectRefusal(edit("map.semantic", "tiles", all), {"tiles/index.yaml", "--overwrite"});
  succeeded(edit("map.semantic", "tiles", joined(all, box, {"-f"})));
  EXPECT_TRUE(semantic_octree::loadMap(path("tiles")) == edited(box));
}

TEST_F(SemanticMapEdit, colorsOfOurOwnOctreesBecomeClassesAgain) {
  ASSERT_EQ(exportTo({"color.ot"}).status, 0);
  const SemanticOcTree imported = edited({}, "color.ot");
  EXPECT_EQ(imported.classes(), map.classes());
  int withClass = 0;
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
    const CellState before = map.query(*leaf), after = imported.query(leaf.getKey());
    ASSERT_EQ(after.status, before.status);
    // A single class is not believed more than that.
    const double most = map.filterParameters().maxProbability;
    ASSERT_NEAR(std::min(after.occupancy, most), std::min(before.occupancy, most), 1e-3);
    if (before.status != CellState::Status::Occupied) continue;
    ASSERT_EQ(after.likeliestClass, before.likeliestClass);
    withClass += before.likeliestClass != 0;
  }
  EXPECT_GT(withClass, 100);
  // Every program that reads maps reads it.
  succeeded(runProgram("semantic-map-merge",
                       {path("color.ot"), path("out.semantic"), "-o", path("sum.semantic")}));
}

TEST_F(SemanticMapEdit, octomapsFilesBecomeOccupancy) {
  ASSERT_EQ(exportTo({"plain.ot"}, {"--no-colors"}).status, 0);
  ASSERT_EQ(exportTo({"binary.bt"}).status, 0);
  for (const char* name : {"plain.ot", "binary.bt"}) {
    const SemanticOcTree imported = edited({}, name);
    EXPECT_EQ(imported.numClasses(), 1);
    for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf)
      ASSERT_EQ(imported.query(leaf.getKey()).status, map.query(*leaf).status) << name;
  }
  const SemanticOcTree like = edited({"--like", path("map.semantic")}, "binary.bt");
  EXPECT_EQ(like.classes(), map.classes());
  EXPECT_EQ(like.filterParameters(), map.filterParameters());
}

TEST_F(SemanticMapEdit, badInputIsRefused) {
  for (const auto& [options, parts] : std::vector<std::pair<Words, Words>>{
           {{"--resolution", "0.5"}, {"0.5", "0.2"}},
           {{"--resolution", "0.1"}, {"0.1", "0.2"}},
           {{"--tiles", "50"}, {"--tiles", "50", "0.2"}},
           {{"--box", "1,0,0,0,1,1"}, {"map.semantic: ", "the box from 1,0,0 to 0,1,1 m is empty"}},
           {{"--like", path("map.semantic")}, {"--like"}}})
    expectRefusal(edit("map.semantic", "out.semantic", options), parts);
  folder.write("bad.ot", "no map");
  for (const char* name : {"none.semantic", "none.bt", "bad.ot"})
    expectRefusal(edit(name, "out.semantic"), {name});
  expectRefusal(edit("map.semantic", "no/folder.semantic"), {"folder.semantic"});
  EXPECT_FALSE(std::filesystem::exists(folder / "out.semantic"));
}

/** Ten maps of one scan each. */
class SemanticMapMerge : public FolderTest {
 protected:
  static constexpr int kMaps = 10;

  void SetUp() override {
    for (int i = 0; i < kMaps; ++i) saveTree(smallPlace(i, 1), path(name(i)));
  }
  static std::string name(int i) { return "scan" + std::to_string(i) + ".semantic"; }

  ProgramRun merge(const Words& names, const std::string& out, const Words& options = {}) const {
    Words maps;
    for (const std::string& map : names) maps.push_back(path(map));
    return runProgram("semantic-map-merge", joined(maps, {"-o", path(out), "-f"}, options));
  }
  Words all() const {
    Words names;
    for (int i = 0; i < kMaps; ++i) names.push_back(name(i));
    return names;
  }
  SemanticOcTree load(const std::string& file) const {
    return semantic_octree::loadMap(path(file));
  }
};

}  // namespace

TEST_F(SemanticMapMerge, tenMapsGiveOneMapInAnyGroups) {
  ASSERT_EQ(merge(all(), "sum.semantic").status, 0);
  ASSERT_EQ(merge({name(7), name(2), name(9)}, "a.semantic", {"--partial"}).status, 0);
  ASSERT_EQ(merge({name(0), "a.semantic", name(5)}, "b.semantic", {"--partial"}).status, 0);
  ASSERT_EQ(merge({name(1), name(3)}, "c.semantic", {"--partial"}).status, 0);
  ASSERT_EQ(merge({"c.semantic", name(4), name(8), "b.semantic", name(6)}, "d.semantic").status, 0);
  EXPECT_EQ(folder.read("d.semantic"), folder.read("sum.semantic"));
}

TEST_F(SemanticMapMerge, mapsThatDoNotFitAreRefusedByName) {
  saveTree(SemanticOcTree(0.1, coloredClasses()), path("fine.semantic"));
  saveTree(SemanticOcTree(0.2, numberedClasses(3)), path("classes.semantic"));
  semantic_octree::FilterParameters filter;
  filter.accuracy = 0.7;
  saveTree(SemanticOcTree(0.2, coloredClasses(), filter), path("filter.semantic"));
  const auto refuse = [&](const std::string& map, const std::string& why) {
    expectRefusal(merge({name(0), map}, "out.semantic"), {name(0), map, why});
    EXPECT_FALSE(std::filesystem::exists(folder / "out.semantic"));
  };
  refuse("fine.semantic", "voxels: 0.2 m and 0.1 m; semantic-map-edit " + path("fine.semantic") +
                              " --resolution 0.2 -o coarse.semantic makes them alike");
  refuse("classes.semantic", "classes");
  refuse("filter.semantic", "filter parameters");
  expectRefusal(merge({name(0), "none.semantic"}, "out.semantic"), {"none.semantic"});
  expectRefusal(merge({name(0), name(1), name(0)}, "out.semantic"), {name(0) + ": is given twice"});
}
