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

#define SKIP_WITHOUT_OCTOMAP_TOOLS()                             \
  if (std::system("command -v convert_octree > /dev/null") != 0) \
  GTEST_SKIP() << "needs the package octomap-tools"

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
