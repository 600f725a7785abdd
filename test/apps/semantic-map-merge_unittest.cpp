#include "ExportFixture.h"

using semantic_octree::SemanticOcTree;

namespace {

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

TEST_F(SemanticMapMerge, mapsAreAddedWhereTheirPosesPutThem) {
  saveTree(smallPlace(0, 1), path("here.semantic"));
  folder.write("poses.txt", "# name x y z yaw pitch roll\n\nscan0.semantic 4 -2 0.4 180 0 0\n");
  ASSERT_EQ(
      merge({"here.semantic", name(0)}, "sum.semantic", {"--poses", path("poses.txt")}).status, 0);
  const SemanticOcTree sum = load("sum.semantic"), one = load(name(0));
  int looked = 0;
  for (auto leaf = one.begin_leafs(); leaf != one.end_leafs(); ++leaf) {
    // 180 degrees about z, by whole voxels.
    const double x = 4 - leaf.getX(), y = -2 - leaf.getY(), z = 0.4 + leaf.getZ();
    if (one.query(x, y, z).status != semantic_octree::CellState::Status::Unknown) continue;
    ASSERT_EQ(sum.query(x, y, z).status, one.query(*leaf).status) << x << " " << y << " " << z;
    ++looked;
  }
  EXPECT_GT(looked, 1000);
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
                              " --resolution 0.2 -o ");
  refuse("classes.semantic", "classes");
  refuse("filter.semantic", "filter parameters");
  expectRefusal(merge({name(0), "none.semantic"}, "out.semantic"), {"none.semantic"});
}

TEST_F(SemanticMapMerge, posesThatMakeNoSenseAreRefusedByLine) {
  const auto refuse = [&](const std::string& line, const Words& parts) {
    folder.write("poses.txt", "# poses\n" + line + "\n");
    expectRefusal(merge({name(0), name(1)}, "out.semantic", {"--poses", path("poses.txt")}),
                  joined({"poses.txt:2"}, parts));
  };
  refuse("scan0.semantic 1 2 3", {"yaw pitch roll"});
  refuse("scan0.semantic 1 2 3 4 5 6 7", {"yaw pitch roll"});
  refuse("scan0.semantic 1 2 x 4 5 6", {"yaw pitch roll"});
  refuse("other.semantic 1 2 3 4 5 6", {"other.semantic", "none"});
}
