// What OctoMap's own reader and its stock tools make of exported octrees.
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <cstdlib>
#include <memory>

#include "ExportFixture.h"

using semantic_octree::SemanticOcTree;

namespace {

class ExportedOctrees : public MapTool {
 protected:
  template <class Tree>
  std::unique_ptr<Tree> read(const std::string& name) const {
    auto* tree = octomap::AbstractOcTree::read(path(name));
    return std::unique_ptr<Tree>(dynamic_cast<Tree*>(tree));
  }

  /** Runs a tool of OctoMap's. \return what it prints; fails the test if it fails */
  std::string tool(const std::string& command) const {
    const std::string all = command + " > " + path("tool.txt") + " 2>&1";
    EXPECT_EQ(std::system(all.c_str()), 0) << folder.read("tool.txt");
    return folder.read("tool.txt");
  }
};

#define SKIP_WITHOUT_OCTOMAP_TOOLS()                                             \
  if (std::system("command -v compare_octrees convert_octree > /dev/null") != 0) \
  GTEST_SKIP() << "needs the package octomap-tools"

/** The same occupancy through OctoMap's own insertion: all voxels one by one. */
std::unique_ptr<octomap::OcTree> octomapsOwn(const SemanticOcTree& map) {
  auto tree = std::make_unique<octomap::OcTree>(map.getResolution());
  tree->setClampingThresMin(1e-6);
  tree->setClampingThresMax(1 - 1e-6);
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
    const auto key = leaf.getIndexKey();
    const int edge = 1 << (16 - leaf.getDepth());
    for (int x = 0; x < edge; ++x)
      for (int y = 0; y < edge; ++y)
        for (int z = 0; z < edge; ++z)
          tree->setNodeValue(octomap::OcTreeKey(key[0] + x, key[1] + y, key[2] + z),
                             leaf->getLogOdds(), true);
  }
  tree->updateInnerOccupancy();
  return tree;
}

}  // namespace

TEST_F(ExportedOctrees, octomapReadsEachLeafWithItsColor) {
  ASSERT_EQ(exportTo({"map.ot"}).status, 0);
  const auto tree = read<octomap::ColorOcTree>("map.ot");
  ASSERT_TRUE(tree);
  EXPECT_EQ(tree->getResolution(), map.getResolution());
  EXPECT_EQ(tree->size(), map.size());
  auto theirs = tree->begin_leafs();
  for (auto ours = map.begin_leafs(); ours != map.end_leafs(); ++ours, ++theirs) {
    ASSERT_EQ(theirs.getKey(), ours.getKey());
    ASSERT_EQ(theirs.getDepth(), ours.getDepth());
    ASSERT_EQ(theirs->getLogOdds(), ours->getLogOdds());
    const auto state = map.query(*ours);
    ASSERT_EQ(theirs->isColorSet(), map.isNodeOccupied(*ours));
    if (!map.isNodeOccupied(*ours) || state.likeliestClass == 0) continue;
    const auto color = map.classes().color(state.likeliestClass);
    ASSERT_EQ(theirs->getColor(), octomap::ColorOcTreeNode::Color(color.r, color.g, color.b));
  }
  EXPECT_EQ(theirs, tree->end_leafs());
}

TEST_F(ExportedOctrees, compareOctreesFindsNoDifferenceToOctomapsOwnTree) {
  SKIP_WITHOUT_OCTOMAP_TOOLS();
  ASSERT_EQ(exportTo({"ours.ot"}, {"--no-colors"}).status, 0);
  octomapsOwn(map)->write(path("theirs.ot"));
  const std::string text = tool("compare_octrees " + path("ours.ot") + " " + path("theirs.ot"));
  EXPECT_TRUE(contains(text, "\nKLD: 0\n")) << text;
  EXPECT_FALSE(contains(text, "ERROR")) << text;
}

TEST_F(ExportedOctrees, convertOctreeKeepsWhatIsFreeAndOccupied) {
  SKIP_WITHOUT_OCTOMAP_TOOLS();
  ASSERT_EQ(exportTo({"map.bt"}).status, 0);
  tool("convert_octree " + path("map.bt") + " " + path("converted.ot"));
  const auto tree = read<octomap::OcTree>("converted.ot");
  ASSERT_TRUE(tree);
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
    const auto* node = tree->search(leaf.getKey());
    ASSERT_TRUE(node);
    ASSERT_EQ(tree->isNodeOccupied(node), map.isNodeOccupied(*leaf));
  }
}

TEST_F(ExportedOctrees, anEmptyMapIsAnEmptyOctree) {
  saveTree(SemanticOcTree(0.5, coloredClasses()), path("map.semantic"));
  const ProgramRun run = exportTo({"map.ot", "map.bt"});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(read<octomap::ColorOcTree>("map.ot")->size(), 0u);
  octomap::OcTree tree(0.1);
  EXPECT_TRUE(tree.readBinary(path("map.bt")));
  EXPECT_EQ(tree.getResolution(), 0.5);
}
