// Maps of older versions of the format. Of version 1: log-odds are floats, and there are no blocks.
#include <semantic_octree/LabelEvidence.h>

#include <cmath>

#include "CraftedTreeFile.h"
#include "RandomScans.h"
#include "TemporaryFolder.h"

using namespace semantic_octree;

namespace {

using u8 = std::uint8_t;
using u16 = std::uint16_t;

SemanticOcTree oldTreeOf(const Header& header, const std::string& nodes) {
  return treeOf(fileAround(header.bytes(1) + nodes, 1));
}

/** What reading says. */
std::string error(std::uint64_t numNodes, const std::string& nodes) {
  Header h;
  h.numNodes = numNodes;
  return errorOf([&] { oldTreeOf(h, nodes); });
}

/** Writes a map as version 1 did, each log-odds less than half a unit beside the map's. */
class OldWriter {
 public:
  OldWriter(const SemanticOcTree& map, std::mt19937& random) : m_map(map), m_random(random) {}

  std::string nodes() {
    m_bytes = bytesOf(kindOf(m_map.root()));
    put(m_map.root());
    return m_bytes;
  }

 private:
  static u8 kindOf(const SemanticOcTreeNode& node) {
    return static_cast<u8>(!node ? 0 : !node.isLeaf() ? 3 : node.hasClassRecord() ? 2 : 1);
  }
  void put(const SemanticOcTreeNode& node) { node.isLeaf() ? putLeaf(node) : putChildren(node); }
  void putLeaf(const SemanticOcTreeNode& leaf) {
    putLogOdds(leaf.getLogOdds());
    if (!leaf.hasClassRecord()) return;
    const ClassBelief<float> belief = m_map.belief(leaf);
    append(m_bytes, belief.count);
    putLogOdds(belief.rest);
    for (int i = 0; i < belief.count; ++i) {
      append(m_bytes, belief.ids[i]);
      putLogOdds(belief.logOdds[i]);
    }
  }
  void putChildren(const SemanticOcTreeNode& inner) {
    unsigned kinds = 0;
    for (int i = 0; i < 8; ++i) kinds |= unsigned(kindOf(inner.child(i))) << 2 * i;
    append(m_bytes, static_cast<u16>(kinds));
    for (const bool leaves : {true, false})
      for (int i = 0; i < 8; ++i)
        if (const auto child = inner.child(i); child && child.isLeaf() == leaves) put(child);
  }
  void putLogOdds(float value) {
    append(m_bytes, static_cast<float>(value + between(m_random, -0.49, 0.49) / 1024));
  }

  const SemanticOcTree& m_map;
  std::mt19937& m_random;
  std::string m_bytes;
};

/** A map with leaves at several depths, some with class records. */
struct OldMap {
  Header header;
  SemanticOcTree map;
  std::string nodes;

  explicit OldMap(bool pruning) : header(headerOf(pruning)), map(oldTreeOf(header, "")) {
    std::mt19937 random(3);
    for (int i = 0; i < 3; ++i) {
      const PosedCloud scan = randomScan(random);
      for (int repeat = 0; repeat < 5; ++repeat) map.insert(scan.cloud, scan.T_map_sensor);
    }
    header.numNodes = map.size();
    nodes = OldWriter(map, random).nodes();
  }

 private:
  static Header headerOf(bool pruning) {
    Header header;
    header.pruning = pruning;
    header.names = {"a", "b", "c", "d", "e"};
    return header;
  }
};

}  // namespace

TEST(OldTreeFile, hasTheCorrelationOfLabelsThatItWasNearlyMadeWithAndNoCalibration) {
  Header header;
  header.halfLife = 2;
  for (const std::uint32_t version : {1, 2, 3, 4}) {
    const SemanticOcTree map = treeOf(fileAround(header.bytes(version), version));
    FilterParameters expected = map.filterParameters();
    expected.labelCorrelation = version == 4 ? 0.2 : 0.5;
    EXPECT_TRUE(map.filterParameters().calibration.isIdentity());
    EXPECT_EQ(map.filterParameters(), expected) << version;
    EXPECT_EQ(map.filterParameters().accuracy, header.accuracy);
    EXPECT_EQ(map.classes().hasHalfLives(), version >= 3);
    std::stringstream again;
    writeTree(again, map);
    EXPECT_TRUE(readTree(again) == map) << version;
  }
  // Those maps counted the n labels of a class in one scan as ln(n + a).
  const double a = 0.1 / (0.9 * 24 - 1);
  const LabelEvidence evidence(0.9, 24, 0.5);
  for (int n = 1; n < 100; ++n)
    EXPECT_NEAR(evidence(n), std::log((n + a) / a), 0.1 * std::log(n) + 0.01) << n;
}

TEST(OldTreeFile, isReadWithLogOddsRounded) {
  for (const bool pruning : {true, false}) {
    const OldMap old(pruning);
    EXPECT_TRUE(oldTreeOf(old.header, old.nodes) == old.map);
  }
}

TEST(OldTreeFile, withBytesAlteredOrMissingIsRefusedOrIsAMap) {
  const OldMap old(true);
  EXPECT_GT(tryAlteredContent(old.header.bytes(1) + old.nodes, 1), 100);
}

TEST(OldTreeFile, withLogOddsThatAreNotKeptAnyMoreIsReadWithTheNearest) {
  Header header;
  header.numNodes = 3;
  const SemanticOcTree map = oldTreeOf(header, bytesOf(u8(3), u16(0x5), 63.5f, -1e30f));
  EXPECT_EQ(map.search({0, 0, 0}).getLogOdds(), 32767 / 1024.f);
  EXPECT_EQ(map.search({32768, 0, 0}).getLogOdds(), -32767 / 1024.f);
}

TEST(OldTreeFile, ofBrokenNodesIsRefused) {
  EXPECT_EQ(error(1, bytesOf(u8(1), 0.5f)), "");
  EXPECT_EQ(error(2, bytesOf(u8(3), u16(1), 0.5f)), "");
  EXPECT_EQ(error(1, bytesOf(u8(2), 0.5f, u8(1), -1.f, u8(2), 1.f)), "");
  EXPECT_TRUE(contains(error(1, ""), "ends too early"));
  EXPECT_TRUE(contains(error(1, bytesOf(u8(0))), "no root"));
  EXPECT_TRUE(contains(error(1, bytesOf(u8(4))), "node kind"));
  EXPECT_TRUE(contains(error(1, bytesOf(u8(1), NAN)), "not finite"));
  EXPECT_TRUE(contains(error(1, bytesOf(u8(3), u16(0))), "without children"));
  EXPECT_TRUE(contains(error(3, bytesOf(u8(3), u16(1), 0.5f)), "2 nodes, expected 3"));
  EXPECT_TRUE(contains(error(~0ull, bytesOf(u8(3), u16(1), 0.5f)), "nodes, expected"));
  EXPECT_TRUE(contains(error(1, bytesOf(u8(2), 0.5f, u8(3), -1.f, u8(2), 1.f)), "named classes"));
  EXPECT_TRUE(contains(error(1, bytesOf(u8(2), 0.5f, u8(1), -1.f, u8(3), 1.f)), "class = 3"));
  for (const int depth : {15, 16}) {
    std::string chain = bytesOf(u8(3));
    for (int i = 0; i < depth; ++i) chain += bytesOf(u16(3));
    EXPECT_TRUE(contains(error(18, chain + bytesOf(u16(0))), depth < 16 ? "without" : "16 levels"));
  }
}
