// Files whose checksums are right and whose content is not.
#include "CraftedTreeFile.h"

#include <cmath>

#include "RandomScans.h"
#include "TemporaryFolder.h"

using namespace semantic_octree;

namespace {

using u8 = std::uint8_t;
using u16 = std::uint16_t;
using i16 = std::int16_t;

/** What reading says. */
std::string error(const Header& header, const std::string& nodes = {}) {
  return errorOf([&] { treeOf(fileAround(header.bytes() + nodes)); });
}

std::string error(std::uint64_t numNodes, const std::string& nodes) {
  Header h;
  h.numNodes = numNodes;
  return error(h, nodes);
}

/** A map that is one block, at the lowest corner. \param numNodes without the 15 above it */
std::string errorOfBlock(std::uint64_t numNodes, const std::string& block) {
  std::string nodes = bytesOf(u8(3));
  for (int depth = 0; depth < 14; ++depth) nodes += bytesOf(u16(3));
  return error(15 + numNodes, nodes + block);
}

}  // namespace

TEST(CraftedTreeFile, ofSenselessHeadersIsRefused) {
  const auto with = [](auto change) {
    Header h;
    change(h);
    return h;
  };
  EXPECT_EQ(error({}), "");
  EXPECT_TRUE(contains(error(with([](Header& h) { h.resolution = -1; })), "resolution"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.resolution = NAN; })), "resolution"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.pruning = 2; })), "pruning"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.free = 7; })), "increments"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.accuracy = 3; })), "accuracy"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.minOccupancy = 1e-12; })), "min_occupancy"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.labelCorrelation = 1.01; })), "correlation"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.power = 0; })), "calibration.power"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.shared = 1; })), "calibration.shared"));
  EXPECT_EQ(error(with([](Header& h) { h.halfLife = 2, h.clock = 5; })), "");
  EXPECT_TRUE(contains(error(with([](Header& h) { h.clock = 5; })), "a clock that cannot be"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.clock = -5; })), "a clock that cannot be"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.names = {}; })), "number of classes"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.names = {"a", "a"}; })), "two classes"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.policy = 2; })), "unknown raw id"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.numFolds = 4000000000u; })), "altered"));
  EXPECT_TRUE(contains(error({}, "more"), "more content"));
}

TEST(CraftedTreeFile, ofClassNamesWithControlCharactersIsRefused) {
  Header h;
  h.names = {"road\n!touch x\n", "b"};
  EXPECT_TRUE(contains(error(h), "the name of class 1, 'road\\x0a!touch x\\x0a'")) << error(h);
}

TEST(CraftedTreeFile, ofBrokenNodesIsRefused) {
  const i16 half = 512, most = 32767, none = -32768;
  EXPECT_EQ(error(1, bytesOf(u8(1), most)), "");
  EXPECT_EQ(error(2, bytesOf(u8(3), u16(1), half)), "");
  EXPECT_EQ(error(1, bytesOf(u8(2), half, u8(1), half, u8(2), i16(-most))), "");
  EXPECT_TRUE(contains(error(1, ""), "ends too early"));
  EXPECT_TRUE(contains(error(1, bytesOf(u8(0))), "no root"));
  EXPECT_TRUE(contains(error(1, bytesOf(u8(4))), "node kind"));
  EXPECT_TRUE(contains(error(1, bytesOf(u8(1), none)), "out of range"));
  EXPECT_TRUE(contains(error(1, bytesOf(u8(2), half, u8(0), none)), "out of range"));
  EXPECT_TRUE(contains(error(1, bytesOf(u8(2), half, u8(1), half, u8(1), none)), "out of range"));
  EXPECT_TRUE(contains(error(1, bytesOf(u8(3), u16(0))), "without children"));
  EXPECT_TRUE(contains(error(3, bytesOf(u8(3), u16(1), half)), "2 nodes, expected 3"));
  EXPECT_TRUE(contains(error(~0ull, bytesOf(u8(3), u16(1), half)), "nodes, expected"));
  const auto record = [&](u8 count, u8 id, u8 second) {
    return bytesOf(u8(2), half, count, half, id, half, second, half);
  };
  EXPECT_EQ(error(1, record(2, 1, 2)), "");
  EXPECT_TRUE(contains(error(1, record(3, 1, 2)), "named classes = 3"));
  EXPECT_TRUE(contains(error(1, record(2, 1, 3)), "class = 3"));
  EXPECT_TRUE(contains(error(1, record(2, 0, 1)), "class 0 in a class record"));
  EXPECT_TRUE(contains(error(1, record(2, 2, 2)), "class 2 twice"));
}

TEST(CraftedTreeFile, ofBlocksThatCannotBeIsRefused) {
  const i16 a = 100, b = -200;
  // Octant 0 is a leaf, of octant 5 voxels 1 and 7 are known, the latter has a record.
  EXPECT_EQ(errorOfBlock(4, bytesOf(u8(0x21), u8(1), u8(0), u8(0x82), u8(0x80), a, b, a, u8(0), b)),
            "");
  EXPECT_EQ(errorOfBlock(1, bytesOf(u8(1), u8(1), u8(1), a, u8(0), b)), "");
  EXPECT_TRUE(contains(errorOfBlock(2, bytesOf(u8(1), u8(1), u8(0), a)), "16 nodes, expected 17"));
  EXPECT_TRUE(contains(errorOfBlock(1, bytesOf(u8(1), u8(1), u8(1), a)), "ends too early"));
  EXPECT_TRUE(contains(errorOfBlock(1, bytesOf(u8(1), u8(1), u8(0), i16(-32768))), "out of range"));
  const auto cannotBe = [](const std::string& block) {
    return contains(errorOfBlock(1, block), "a block that cannot be");
  };
  EXPECT_TRUE(cannotBe(bytesOf(u8(0), u8(0), u8(0)))) << "nothing is known";
  EXPECT_TRUE(cannotBe(bytesOf(u8(1), u8(2), u8(0), a))) << "a leaf that is not known";
  EXPECT_TRUE(cannotBe(bytesOf(u8(3), u8(1), u8(2), a))) << "a leaf's record without the leaf";
  EXPECT_TRUE(cannotBe(bytesOf(u8(1), u8(0), u8(0), u8(0), u8(0)))) << "an octant without voxels";
  EXPECT_TRUE(cannotBe(bytesOf(u8(1), u8(0), u8(0), u8(1), u8(2), a, u8(0), b)))
      << "a record without its voxel";
}

TEST(CraftedTreeFile, holdsWhatItsBlocksSay) {
  Header h;
  h.numNodes = 19;
  std::string nodes = bytesOf(u8(3));
  for (int depth = 0; depth < 14; ++depth) nodes += bytesOf(u16(3));
  nodes += bytesOf(u8(0x21), u8(1), u8(1), u8(0x82), u8(0x80));
  nodes += bytesOf(i16(1024), i16(-512), i16(512));       // octant 0; octant 5, voxels 1 and 7
  nodes += bytesOf(u8(1), i16(-1024), u8(2), i16(2048));  // record of octant 0
  nodes += bytesOf(u8(0), i16(-3));                       // and of the last voxel
  const SemanticOcTree tree = treeOf(fileAround(h.bytes() + nodes));
  const auto leaf = tree.search({1, 0, 1}), other = tree.search({3, 0, 2}),
             last = tree.search({3, 1, 3});
  EXPECT_EQ(leaf, tree.search({0, 0, 0}, 15));
  EXPECT_EQ(leaf.getLogOdds(), 1);
  EXPECT_EQ(tree.belief(leaf).ids[0], 2);
  EXPECT_EQ(tree.belief(leaf).logOdds[0], 2);
  EXPECT_EQ(tree.belief(leaf).rest, -1);
  EXPECT_EQ(other.getLogOdds(), -0.5);
  EXPECT_FALSE(other.hasClassRecord());
  EXPECT_EQ(last.getLogOdds(), 0.5);
  EXPECT_EQ(tree.belief(last).rest, -3 / 1024.f);
  EXPECT_EQ(tree.root().getLogOdds(), 1);
  for (const octomap::OcTreeKey& key : {octomap::OcTreeKey(2, 0, 2), {0, 2, 0}, {4, 0, 0}})
    EXPECT_FALSE(tree.search(key));
}

TEST(CraftedTreeFile, withBytesAlteredOrMissingIsRefusedOrIsAMap) {
  std::mt19937 random(1);
  SemanticOcTree map(0.5, numberedClasses(5));
  for (int i = 0; i < 3; ++i) {
    const PosedCloud scan = randomScan(random);
    for (int repeat = 0; repeat < 3; ++repeat) map.insert(scan.cloud, scan.T_map_sensor);
  }
  std::ostringstream out;
  writeTree(out, map);
  const std::string content = contentIn(out.str());
  ASSERT_TRUE(treeOf(fileAround(content)) == map);
  EXPECT_GT(tryAlteredContent(content), 100);
}
