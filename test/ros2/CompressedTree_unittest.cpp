// Copies of the compressed tree in another process.
#include <gtest/gtest.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/TreeFile.h>

#include <random>
#include <sstream>

#include "MapMessages.h"
#include "RoadInGrass.h"

namespace {

using semantic_map_ros2::TreeReader;
using semantic_octree::Abstraction;
using semantic_octree::SemanticOcTree;

const std::string kRelevant = "road: 1, grass: 1, wall: 1";
constexpr double kAlpha = 0.0002;

/** A map but for its calibration, which is fitted anew only when that of the whole map changes. */
std::string bytesOf(SemanticOcTree map) {
  map.setCalibration({});
  std::ostringstream out;
  writeTree(out, map);
  return out.str();
}

/** What the program's compressed tree is, by the map that it saves. */
std::string compressed(SemanticOcTree map) {
  semantic_octree::AbstractionOptions options;
  options.relevant = kRelevant;
  options.weights.alpha = kAlpha;
  setAbstraction(map, options);
  return bytesOf(Abstraction(map).compressedMap());
}

class CompressedTree : public RoadInGrass {
 protected:
  void SetUp() override {
    start({"-p", "abstraction.relevant:=" + kRelevant, "-p",
           "abstraction.alpha:=" + std::to_string(kAlpha)});
    m_save = std::make_unique<ros2::Publication<ros2::Empty>>(live->node(), "/semantic_map/save",
                                                              ros2::Qos());
  }

  /** A part of the world, with things in the air. */
  semantic_types::LabeledCloud someScan() {
    semantic_types::LabeledCloud cloud;
    const auto all = scan();
    for (std::size_t i = 0; i < all.size(); ++i)
      if (m_random() % 3 == 0) {
        cloud.points.push_back(all.points[i] + Eigen::Vector3f(0, 0, m_random() % 50 == 0));
        cloud.classes.push_back(all.classes[i]);
      }
    return cloud;
  }
  void seeSome(int times) {
    for (int i = 0; i < times; ++i) see(++m_scans, someScan());
  }
  /** The tree of the program, now. */
  std::string told() {
    const std::string before = live->said();
    live->send(*m_save, {});
    live->waitFor([&] { return contains(live->said().substr(before.size()), ": saved"); });
    return compressed(live->map());
  }
  /** Waits until a copy is a tree, to the last bit. */
  bool becomes(TreeReader& reader, const std::string& tree) {
    return live->waitFor([&] {
      EXPECT_EQ(reader.look(), "");
      const auto map = reader.map();
      return reader.isCurrent() && map && bytesOf(*map) == tree;
    });
  }

  std::size_t m_scans = 0;

 private:
  std::mt19937 m_random{1};
  std::unique_ptr<ros2::Publication<ros2::Empty>> m_save;
};

}  // namespace

TEST_F(CompressedTree, isCopiedToTheLastBitByWhoeverComes) {
  TreeReader first(live->node(), "/semantic_map");
  for (int round = 0; round < 4; ++round) {
    seeSome(3);
    ASSERT_TRUE(becomes(first, told())) << round;
  }
  EXPECT_FALSE(live->map().filterParameters().calibration.isIdentity());
  EXPECT_FALSE(first.map()->filterParameters().calibration.isIdentity());
  TreeReader late(live->node(), "/semantic_map");  // nothing is seen meanwhile
  EXPECT_TRUE(becomes(late, told()));
  seeSome(2);
  const std::string tree = told();
  EXPECT_TRUE(becomes(first, tree));
  EXPECT_TRUE(becomes(late, tree));
  EXPECT_EQ(live->end(), kStopped) << live->said();
}

TEST_F(CompressedTree, isCopiedByTheProgram) {
  seeSome(3);
  const std::string tree = told();
  LiveMap copy({}, {"--copy", "/semantic_map"}, live.get());
  ASSERT_TRUE(copy.waitFor([&] { return contains(copy.said(), "The tree has come"); }));
  EXPECT_EQ(copy.end(), kStopped) << copy.said();
  EXPECT_TRUE(bytesOf(copy.map()) == tree);
  LiveMap nothing({}, {"--copy", "/another"}, live.get());
  EXPECT_EQ(nothing.end(), 1);
  EXPECT_TRUE(contains(nothing.said(), "/another: no compressed tree came"));
}

TEST_F(CompressedTree, isCopiedAnewWhereAChangeWasLost) {
  // Changes come through another hand, which loses some.
  ros2::Publication<ros2::Octomap> relay(live->node(), "/relay/change", {true, false, 100});
  std::atomic<bool> isLossy{false};
  std::atomic<int> lost{0};
  ros2::Subscription<ros2::Octomap> hears(
      live->node(), "/semantic_map/change", {true, false, 100},
      [&](auto change) { isLossy ? void(++lost) : void(relay.write(*change)); });
  ros2::Arguments arguments;
  arguments.remappings = {{"/semantic_map/change", "/relay/change"}};
  ros2::Node other("other", arguments);
  TreeReader reader(other, "/semantic_map");
  ASSERT_TRUE(live->waitFor([&] { return relay.isRead(); }));
  seeSome(2);
  ASSERT_TRUE(becomes(reader, told()));
  isLossy = true;
  seeSome(1);
  ASSERT_TRUE(live->waitFor([&] { return lost > 0; }));
  const std::string unheard = told();
  EXPECT_TRUE(reader.isCurrent()) << "it cannot know yet";
  isLossy = false;
  seeSome(1);
  EXPECT_TRUE(live->waitFor([&] { return !reader.isCurrent(); }));
  const std::string tree = told();
  EXPECT_NE(tree, unheard);
  EXPECT_TRUE(becomes(reader, tree));
  EXPECT_EQ(live->end(), kStopped) << live->said();
}

TEST_F(RoadInGrass, hasNoCompressedTreeWithoutAnAbstraction) {
  start({});
  TreeReader reader(live->node(), "/semantic_map");
  ros2::Publication<ros2::Octomap> another(live->node(), "/semantic_map/change", {});
  live->waitFor([&] { return another.isRead(); });
  see(1);
  EXPECT_TRUE(live->waitFor([&] { return contains(live->said(), "no abstraction"); }));
  EXPECT_FALSE(reader.map().has_value());
  std::string id = "OcTree", problem;
  ros2::Octomap octree{};
  octree.id = id.data();
  another.write(octree);
  EXPECT_TRUE(live->waitFor([&] { return !(problem = reader.look()).empty(); }));
  EXPECT_EQ(problem, "a message of 'OcTree', expected SemanticTree");
  EXPECT_EQ(live->end(), kStopped) << live->said();
}
