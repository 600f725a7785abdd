#include <gtest/gtest.h>
#include <semantic_octree/Abstraction.h>
#include <semantic_octree/MapStream.h>
#include <semantic_octree/TreeFile.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "RandomScans.h"
#include "StreamPackets.h"
#include "TemporaryFolder.h"

namespace {

using namespace semantic_octree;
using tree_abstraction::irrelevant;
using tree_abstraction::relevant;

constexpr int K = 6;
constexpr std::uint32_t kStream = 0x5eed;

AbstractionOptions someOptions(double alpha) {
  AbstractionOptions o;
  o.weights.terms = {relevant("posts", 1.0, {1}), irrelevant("ground", 0.3, {2, 3}),
                     tree_abstraction::wholeClassVariable("everything", 0.2, K)};
  o.weights.alpha = alpha;
  o.blockSize = 3.2;
  return o;
}

SemanticOcTree mapOf(const std::vector<PosedCloud>& scans, const AbstractionOptions& options) {
  SemanticOcTree map(0.2, numberedClasses(K));
  map.setAbstraction(options);
  for (const PosedCloud& s : scans) map.insert(s.cloud, s.T_map_sensor);
  return map;
}

SemanticOcTree smallPlace(const AbstractionOptions& options, unsigned seed = 7) {
  return mapOf(scansOfSmallPlace(3, 2500, K, seed), options);
}

SemanticOcTree randomMap(const AbstractionOptions& options, unsigned seed) {
  std::mt19937 random(seed);
  RandomScanOptions scans;
  scans.classes = K;
  return mapOf({randomScan(random, scans), randomScan(random, scans)}, options);
}

/** All packets, each once. */
std::vector<Datagram> packetsOf(MapSender& sender) {
  std::vector<Datagram> packets;
  while (auto packet = sender.next()) packets.push_back(*packet);
  return packets;
}

/** A radio that loses, exchanges and repeats datagrams: with the same seed always the same. */
class Radio {
 public:
  Radio(unsigned seed, double loss) : m_random(seed), m_loss(loss) {}

  void send(const Datagram& d) {
    const std::string bytes = d.bytes();
    EXPECT_LE(bytes.size(), kMaxDatagramBytes);
    const int times = chance(m_loss) ? 0 : chance(0.1) ? 2 : 1;
    for (int i = 0; i < times; ++i) m_inAir.push_back(bytes);
  }
  /** Those that come now, in any order; some stay for later. */
  std::vector<Datagram> receive() {
    std::shuffle(m_inAir.begin(), m_inAir.end(), m_random);
    std::vector<Datagram> come;
    for (std::size_t n = m_inAir.size() / 2 + 1; n > 0 && !m_inAir.empty(); --n) {
      come.push_back(Datagram::of(m_inAir.back()));
      m_inAir.pop_back();
    }
    return come;
  }

 private:
  bool chance(double p) { return std::uniform_real_distribution<>(0, 1)(m_random) < p; }

  std::mt19937 m_random;
  double m_loss;
  std::vector<std::string> m_inAir;
};

/** Every leaf of the tree stands for what the map has there. */
void expectValid(const SemanticOcTree& tree, const SemanticOcTree& map) {
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const SemanticOcTreeNode node = map.search(leaf.getKey(), leaf.getDepth());
    ASSERT_TRUE(node);
    ASSERT_EQ(leaf->getLogOdds(), node->getLogOdds());
  }
}

/** Lets both talk until the receiver has the map. \return datagrams that the sender sent */
std::size_t transmit(MapSender& sender, MapReceiver& receiver, Radio& there, Radio& back,
                     const SemanticOcTree* map = nullptr) {
  std::size_t sent = 0;
  for (int round = 0; !sender.isComplete(); ++round) {
    for (int i = 0; i < 8; ++i)
      if (const auto packet = sender.next()) {
        there.send(*packet);
        ++sent;
      } else if (i == 0 && round % 16 == 0) {
        sender.repeat();
      }
    for (const Datagram& d : there.receive()) receiver.accept(d);
    if (map && receiver.hasMap() && round % 8 == 0) expectValid(receiver.map(), *map);
    back.send(receiver.receipt());
    for (const Datagram& d : back.receive()) sender.accept(d);
    EXPECT_LT(round, 100000) << "no end";
    if (round >= 100000) break;
  }
  return sent;
}

TEST(MapStream, arrivesToTheLastBit) {
  for (const double alpha : {0.0, 0.003, 0.02, 10.0}) {
    SemanticOcTree map = smallPlace(someOptions(alpha));
    MapSender sender(kStream);
    sender.setMap(map);
    MapReceiver receiver(kStream);
    EXPECT_FALSE(receiver.hasMap());
    for (const Datagram& packet : packetsOf(sender)) receiver.accept(packet);
    EXPECT_TRUE(receiver.isFinished());
    EXPECT_TRUE(fileOf(receiver.map()) == fileOf(Abstraction(map).compressedMap())) << alpha;
    EXPECT_EQ(receiver.numLeaves(), Abstraction(map).leaves().size());
  }
}

TEST(MapStream, eachPrefixIsTheCompressedTreeOfItsAlpha) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    SemanticOcTree map =
        seed == 1 ? smallPlace(someOptions(0.0005)) : randomMap(someOptions(0.0005), seed);
    MapSender sender(kStream);
    sender.setMap(map);
    const auto packets = packetsOf(sender);
    const auto& prefixes = sender.prefixes();
    ASSERT_EQ(packets.size(), prefixes.size());
    MapReceiver receiver(kStream);
    SemanticOcTree other(map);
    std::size_t whole = 0, optimal = 0, bytes = 0;
    for (std::size_t i = 0; i < packets.size(); ++i) {
      receiver.accept(packets[i]);
      bytes += packets[i].bytes().size();
      EXPECT_EQ(prefixes[i].bytes, bytes);
      EXPECT_EQ(receiver.prefix().bytes, bytes);
      EXPECT_EQ(receiver.prefix().alpha.has_value(), prefixes[i].alpha.has_value());
      if (!prefixes[i].alpha) continue;
      ++optimal;
      Abstraction(other).setAlpha(*prefixes[i].alpha);
      const SemanticOcTree tree = receiver.map();
      if (prefixes[i].isWhole) {
        ++whole;
        ASSERT_TRUE(fileOf(tree) == fileOf(Abstraction(other).compressedMap())) << i;
      }
      expectValid(tree, map);
    }
    EXPECT_GT(whole, 3u);
    EXPECT_GT(optimal, packets.size() / 2);
  }
}

/** J of a tree that is the map's with some inner nodes as leaves, node by node from the path. */
double objectiveOf(const SemanticOcTree& tree, SemanticOcTree& map, double alpha) {
  double sum = 0;
  const auto& terms = Abstraction(map).options().weights.terms;
  Abstraction(map).forEachPathNode(
      [&](const Abstraction::PathNode& n, const std::vector<double>& information) {
        if (n.isFree) return;
        const auto node = tree.search(octomapKey(n.lowest.x(), n.lowest.y(), n.lowest.z()),
                                      static_cast<unsigned>(n.depth));
        const bool isThere = node && !node.isLeaf();
        if (!isThere) return;
        sum -= alpha * n.price;
        for (std::size_t t = 0; t < terms.size(); ++t) sum += terms[t].weight * information[t];
      });
  return sum;
}

TEST(MapStream, betweenWholeTreesPrefixesAreWorthAsMuchAsTheBest) {
  SemanticOcTree map = smallPlace(someOptions(0.0005), 11);
  MapSender sender(kStream);
  sender.setMap(map);
  MapReceiver receiver(kStream);
  SemanticOcTree other(map);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < sender.prefixes().size(); ++i) {
    receiver.accept(*sender.next());
    const StreamPrefix& prefix = sender.prefixes()[i];
    if (!prefix.alpha || prefix.isWhole) continue;
    ++compared;
    Abstraction(other).setAlpha(*prefix.alpha);
    const double best = objectiveOf(Abstraction(other).compressedMap(), other, *prefix.alpha);
    const double here = objectiveOf(receiver.map(), other, *prefix.alpha);
    EXPECT_NEAR(here, best, 1e-9 * std::fabs(best) + 1e-15) << i;
  }
  EXPECT_GT(compared, 3u);
}

TEST(MapStream, isValidAtEveryMomentAndEndsWholeOverARadioThatLosesAndExchanges) {
  for (const double loss : {0.0, 0.2, 0.6})
    for (unsigned seed = 0; seed < 4; ++seed) {
      SemanticOcTree map = randomMap(someOptions(0.002), seed);
      MapSender sender(kStream);
      sender.setMap(map);
      MapReceiver receiver(kStream);
      Radio there(seed, loss), back(seed + 100, loss);
      const std::size_t sent = transmit(sender, receiver, there, back, &map);
      ASSERT_TRUE(receiver.isFinished());
      ASSERT_TRUE(fileOf(receiver.map()) == fileOf(Abstraction(map).compressedMap()));
      EXPECT_LT(static_cast<double>(sent),
                20 + 3.0 * static_cast<double>(sender.prefixes().size()) / (1 - loss));
    }
}

TEST(MapStream, whatCameIsOfUseWithoutAnyReceipt) {
  SemanticOcTree map = smallPlace(someOptions(0.001));
  MapSender sender(kStream);
  sender.setMap(map);
  MapReceiver receiver(kStream);
  std::size_t number = 0;
  for (const Datagram& packet : packetsOf(sender))
    if (number++ < 8 || number % 5 != 0) receiver.accept(packet);
  EXPECT_FALSE(receiver.isComplete());
  expectValid(receiver.map(), map);
  EXPECT_GT(receiver.numLeaves(), Abstraction(map).leaves().size() / 3);
}

TEST(MapStream, aSecondScanSendsTheChange) {
  for (const double alpha : {0.0, 0.004}) {
    const auto scans = scansOfSmallPlace(5, 2500, K, 3);
    SemanticOcTree map = mapOf({scans[0], scans[1], scans[2]}, someOptions(alpha));
    MapSender sender(kStream);
    MapReceiver receiver(kStream);
    Radio there(1, 0.2), back(2, 0.2);
    sender.setMap(map, false);
    transmit(sender, receiver, there, back);
    const std::size_t first = sender.prefixes().back().bytes;
    EXPECT_TRUE(receiver.isComplete());
    EXPECT_FALSE(receiver.isFinished());
    SemanticOcTree changed = map;
    const PosedCloud few = scansOfSmallPlace(1, 60, K, 5)[0];
    changed.insert(few.cloud, few.T_map_sensor);
    for (SemanticOcTree* next : {&changed, &map, &map}) {  // it may also become what it was
      sender.setMap(*next, next == &changed);
      if (next == &changed) {
        EXPECT_LT(sender.prefixes().back().bytes, first / 2);
      }
      transmit(sender, receiver, there, back);
      ASSERT_TRUE(fileOf(receiver.map()) == fileOf(Abstraction(*next).compressedMap()));
    }
    EXPECT_LE(sender.prefixes().back().packets, 1u);  // nothing changed: a description alone
  }
}

/** From any map to any other, also to none. \return leaves above the blocks on the way */
std::size_t wander(double blockSize, unsigned seed) {
  AbstractionOptions options = someOptions(0.003);
  options.blockSize = blockSize;
  std::vector<SemanticOcTree> maps;
  for (unsigned i = 0; i < 4; ++i) maps.push_back(randomMap(options, i));
  // Seen often, free space has the lowest value, and merges.
  const PosedCloud scan = scansOfSmallPlace(1, 6000, K, 3)[0];
  maps.push_back(mapOf(std::vector<PosedCloud>(12, scan), options));
  maps.emplace_back(maps[0]);
  maps.back().clear();
  std::mt19937 random(seed);
  MapSender sender(kStream);
  MapReceiver receiver(kStream);
  Radio there(seed, 0.3), back(seed + 100, 0.3);
  std::size_t largeLeaves = 0;
  for (int i = 0; i < 12; ++i) {
    SemanticOcTree& next = maps[random() % maps.size()];
    sender.setMap(next, false);
    transmit(sender, receiver, there, back);
    const SemanticOcTree tree = receiver.map();
    EXPECT_TRUE(fileOf(tree) == fileOf(Abstraction(next).compressedMap())) << i;
    for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf)
      largeLeaves += leaf.getDepth() < static_cast<unsigned>(Abstraction(next).rootDepth());
  }
  return largeLeaves;
}

TEST(MapStream, anyMapMayBecomeAnyOther) {
  for (unsigned seed = 0; seed < 4; ++seed) wander(3.2, seed);
}

TEST(MapStream, leavesAboveTheBlocksAreSplitAndComeBack) {
  for (unsigned seed = 0; seed < 3; ++seed) EXPECT_GT(wander(0.2, seed), 100u);
}

TEST(MapStream, partsOfOneRevisionLeadToOneTreeInAnyOrder) {
  const auto leaf = [](const CellPath& cell, Units value) {
    TreePart part;
    part.cell = cell;
    part.leaves[0] = {{}, value, StreamLeaf::Kind::Plain};
    return part;
  };
  const CellPath large = CellPath::of({32768, 32768, 32768}, 10);
  std::vector<TreePart> parts;
  for (int i = 0; i < 8; ++i) parts.push_back(leaf(large.child(i), static_cast<Units>(i)));
  TreePart octet = leaf(large.child(5), 50);
  octet.isOctet = true;
  octet.mask = 0xf0;
  octet.leaves.fill(octet.leaves[0]);
  parts.push_back(octet);
  const SemanticOcTree empty(0.2, numberedClasses(K));
  std::set<std::string> files;
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    StreamTree tree;
    tree.apply(leaf(large, -7), 1);
    std::shuffle(parts.begin(), parts.end(), random);
    std::vector<TreePart> late;  // whose cube was not there yet
    for (const TreePart& part : parts)
      if (!tree.apply(part, 2)) late.push_back(part);
    for (const TreePart& part : late) EXPECT_TRUE(tree.apply(part, 2));
    EXPECT_EQ(tree.numLeaves(), 11u);
    files.insert(fileOf(tree.map(empty)));
  }
  EXPECT_EQ(files.size(), 1u);
}

TEST(MapStream, whatWasLostIsSentBeforeWhatIsNew) {
  SemanticOcTree map = smallPlace(someOptions(0.0005));
  MapSender sender(kStream);
  sender.setMap(map);
  MapReceiver receiver(kStream);
  std::vector<std::string> sent;
  const auto contentOf = [](const Datagram& d) { return d.payload.substr(20); };
  for (int i = 0; i < 10; ++i) {
    const Datagram packet = *sender.next();
    sent.push_back(contentOf(packet));
    if (i != 3 && i != 6) receiver.accept(packet);
  }
  for (int i = 0; i < 2; ++i) sender.accept(receiver.receipt());  // once is enough
  EXPECT_EQ(contentOf(*sender.next()), sent[3]);
  EXPECT_EQ(contentOf(*sender.next()), sent[6]);
  const std::string fresh = contentOf(*sender.next());
  EXPECT_EQ(std::count(sent.begin(), sent.end(), fresh), 0);
}

TEST(MapStream, aChargedFrameAndNoBlocksTravelToo) {
  for (const double blockSize : {0.0, 3.2, 0.2, 100.0})
    for (const auto frame : {AbstractionOptions::Frame::Free, AbstractionOptions::Frame::Charged}) {
      AbstractionOptions options = someOptions(1e-9);
      options.blockSize = blockSize;
      options.frame = frame;
      SemanticOcTree map = smallPlace(options);
      MapSender sender(kStream);
      sender.setMap(map);
      MapReceiver receiver(kStream);
      for (const Datagram& packet : packetsOf(sender)) receiver.accept(packet);
      EXPECT_TRUE(fileOf(receiver.map()) == fileOf(Abstraction(map).compressedMap()));
    }
}

/** CRC-32, bit by bit. */
std::uint32_t crcOf(const std::string& bytes) {
  std::uint32_t crc = ~0u;
  for (const unsigned char byte : bytes) {
    crc ^= byte;
    for (int i = 0; i < 8; ++i) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
  }
  return ~crc;
}

TEST(MapStream, whatDoesNotBelongHereIsRefusedByName) {
  SemanticOcTree map = smallPlace(someOptions(0.01));
  MapSender sender(kStream);
  sender.setMap(map);
  const Datagram packet = *sender.next();
  std::string bytes = packet.bytes();
  MapReceiver receiver(kStream + 1);
  EXPECT_TRUE(contains(errorOf([&] { receiver.accept(packet); }), "of stream 24301"));
  EXPECT_TRUE(contains(errorOf([&] { sender.accept(packet); }), "expected a receipt"));
  EXPECT_TRUE(contains(errorOf([&] { Datagram::of("hello, world"); }), "another program"));
  EXPECT_TRUE(contains(errorOf([&] { sender.setMap(map); }), "does not have the map"));
  bytes[6] = 9;  // the version
  const std::uint32_t crc = crcOf(bytes.substr(4));
  bytes.replace(0, 4, reinterpret_cast<const char*>(&crc), 4);
  EXPECT_TRUE(contains(errorOf([&] { Datagram::of(bytes); }), "version 9 of the protocol"));
  bytes = packet.bytes();
  bytes.back() ^= 1;
  EXPECT_TRUE(contains(errorOf([&] { Datagram::of(bytes); }), "checksum"));
}

TEST(MapStream, mapsOfAnotherKindAreNoChange) {
  SemanticOcTree map = smallPlace(someOptions(0.01));
  MapSender sender(kStream);
  MapReceiver receiver(kStream);
  sender.setMap(map);
  for (const Datagram& packet : packetsOf(sender)) receiver.accept(packet);
  sender.accept(receiver.receipt());
  ASSERT_TRUE(sender.isComplete());
  SemanticOcTree other(0.2, numberedClasses(K + 1));
  other.setAbstraction(someOptions(0.01));
  EXPECT_TRUE(contains(errorOf([&] { sender.setMap(other); }), "class table"));
  AbstractionOptions options = someOptions(0.01);
  options.blockSize = 6.4;
  map.setAbstraction(options);
  EXPECT_TRUE(contains(errorOf([&] { sender.setMap(map); }), "blocks"));
}

TEST(MapStream, alteredPacketsAreRefusedAndLeaveAValidMap) {
  SemanticOcTree map = smallPlace(someOptions(0.01));
  MapSender sender(kStream);
  sender.setMap(map);
  const auto packets = packetsOf(sender);
  std::mt19937 random(5);
  for (int trial = 0; trial < 300; ++trial) {
    MapReceiver receiver(kStream);
    for (Datagram packet : packets) {
      if (random() % 4 == 0)  // the checksum of such a datagram matches
        for (std::size_t n = 1 + random() % 3; n > 0; --n)
          packet.payload[random() % packet.payload.size()] = static_cast<char>(random());
      if (random() % 16 == 0) packet.payload.resize(random() % packet.payload.size());
      try {
        receiver.accept(packet);
      } catch (const std::exception&) {
      }
    }
    if (!receiver.hasMap()) continue;
    const std::string file = fileOf(receiver.map());
    std::istringstream in(file);
    ASSERT_TRUE(fileOf(readTree(in)) == file);
  }
}

/** A coder's tables with one frequent class record. */
std::string codingWith(const ClassRecord& record, int numClasses, int rootDepth) {
  const std::string none = PartCoder(numClasses, rootDepth).toText();
  std::string text = none.substr(0, 3) + '\1';
  text.append(reinterpret_cast<const char*>(&record), sizeof(record));
  return text + std::string(sizeof(Units), '\0') + none.substr(4);
}

TEST(MapStream, frequentRecordsThatCannotBeAreRefused) {
  for (int count = 0; count < 256; ++count) {
    SCOPED_TRACE(count);
    ClassRecord record{};
    record.count = static_cast<std::uint8_t>(count);
    for (int i = 0; i < std::min(count, 3); ++i) record.ids[i] = static_cast<ClassId>(i + 1);
    std::size_t next = 0;
    PartCoder coder(K, 10);
    const std::string error = errorOf([&] { coder.fromText(codingWith(record, K, 10), next); });
    EXPECT_EQ(error.empty(), count <= 3) << error;
  }
}

TEST(MapStream, nothingStaysOfADescriptionThatFailed) {
  MapReceiver receiver(kStream);
  const auto accept = [&](std::uint32_t number, const std::string& content) {
    PacketHeader header;
    header.revision = 1;
    header.numDescription = 1;
    header.count = 3;
    header.number = number;
    receiver.accept({Datagram::Type::Data, kStream, header.bytes() + content});
  };
  const auto descriptionOf = [](ClassId id, int numClasses, int rootDepth) {
    ClassRecord record{};
    record.count = 1;
    record.ids[0] = id;
    StreamDescription d;
    d.rootDepth = rootDepth;
    d.coding = codingWith(record, numClasses, rootDepth);
    d.kind = fileOf(SemanticOcTree(0.2, numberedClasses(numClasses)));
    return d.compressed();
  };
  // A leaf with the frequent record, in another cube by each of the descriptions.
  PartCoder coder(K, 10);
  std::size_t next = 0;
  ClassRecord record{};
  record.count = 1;
  record.ids[0] = K;
  coder.fromText(codingWith(record, K, 10), next);
  TreePart part;
  part.cell = {0777, 10};
  part.leaves[0].kind = StreamLeaf::Kind::WithRecord;
  part.leaves[0].record = record;
  accept(1, coder.encode({&part}));
  accept(2, "x");
  EXPECT_EQ(errorOf([&] { accept(0, descriptionOf(K, K, 10)); }),
            "altered: a description too short");
  EXPECT_EQ(receiver.map().getNumLeafNodes(), 1u);
  EXPECT_EQ(errorOf([&] { accept(0, descriptionOf(1, 1, 12)); }),
            "altered: a description too short");
  EXPECT_EQ(receiver.map().numClasses(), 1);
  EXPECT_EQ(receiver.map().getNumLeafNodes(), 1u);
}

TEST(MapStream, cutAndAlteredDatagramsDoNotPass) {
  SemanticOcTree map = smallPlace(someOptions(0.01));
  MapSender sender(kStream);
  sender.setMap(map);
  const std::string whole = sender.next()->bytes();
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THROW(Datagram::of(whole.substr(0, size)), std::runtime_error);
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    std::string altered = whole;
    altered[random() % altered.size()] ^= static_cast<char>(1 << random() % 8);
    EXPECT_THROW(Datagram::of(altered), std::runtime_error);
  }
}

}  // namespace
