#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "LossyRadio.h"

namespace {

using namespace streamed_maps;

TEST(MapStream, arrivesToTheLastBit) {
  for (const double alpha : {0.0, 1e-9, 0.003, 0.02, 10.0})
    for (const double blockSize : {0.0, 0.2, 3.2, 100.0})
      for (const auto frame :
           {AbstractionOptions::Frame::Free, AbstractionOptions::Frame::Charged}) {
        AbstractionOptions options = someOptions(alpha);
        options.blockSize = blockSize;
        options.frame = frame;
        SemanticOcTree map = smallPlace(options);
        MapSender sender(kStream);
        sender.setMap(map);
        MapReceiver receiver(kStream);
        EXPECT_FALSE(receiver.hasMap());
        for (const Datagram& packet : packetsOf(sender)) receiver.accept(packet);
        EXPECT_TRUE(receiver.isFinished());
        EXPECT_TRUE(fileOf(receiver.map()) == fileOf(Abstraction(map).compressedMap())) << alpha;
        EXPECT_EQ(receiver.numLeaves(), Abstraction(map).compressedMap().getNumLeafNodes());
      }
}

namespace {

std::vector<double> someFactors() {
  std::vector<double> factors(K, 0.5);
  factors[0] = 3;
  return factors;
}

}  // namespace

TEST(MapStream, whatACalibratedMapStatesArrivesWithEachChange) {
  SemanticOcTree map = smallPlace(someOptions(0.001));
  MapSender sender(kStream);
  MapReceiver receiver(kStream);
  Radio there(1, 0.2), back(2, 0.2);
  std::set<double> powers;
  for (const double power : {0.5, 0.8, 1.2}) {
    map.setCalibration({power, 0.1});
    if (power > 1) map.setCalibration({power, 0.1, someFactors()});
    sender.setMap(map, false);
    transmit(sender, receiver, there, back);
    const SemanticOcTree compressed = Abstraction(map).compressedMap();
    powers.insert(compressed.filterParameters().calibration.power);
    EXPECT_TRUE(fileOf(receiver.map()) == fileOf(compressed)) << power;
  }
  EXPECT_EQ(powers.size(), 3u);
}

std::size_t heap() {
  const struct mallinfo2 use = mallinfo2();
  return use.uordblks + use.hblkhd;
}

TEST(MapStream, aReceiverTakesLittleMoreMemoryThanItsMap) {
  AbstractionOptions options = someOptions(0);
  options.blockSize = 0.4;  // nearly all of the map is sent
  SemanticOcTree map = mapOf(scansOfSmallPlace(12, 20000, K, 7), options);
  MapSender sender(kStream);
  sender.setMap(map);
  const std::vector<Datagram> packets = packetsOf(sender);
  const SemanticOcTree sent = Abstraction(map).compressedMap();
  const std::size_t before = heap();
  MapReceiver receiver(kStream);
  for (const Datagram& packet : packets) receiver.accept(packet);
  const std::size_t taken = heap() - before;
  EXPECT_LT(taken, 2 * sent.memoryUsage());
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

/** Compares what prefixes between whole trees are worth with the best. \return how many there were
 */
std::size_t compareWithTheBest(SemanticOcTree map) {
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
  return compared;
}

TEST(MapStream, betweenWholeTreesPrefixesAreWorthAsMuchAsTheBest) {
  std::size_t compared = 0;
  for (unsigned seed = 11; seed < 17; ++seed)
    compared += compareWithTheBest(smallPlace(someOptions(0.0005), seed));
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
      sender.setMap(*next, false);
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

TEST(MapStream, anyMapMayBecomeAnyOther) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    wander(3.2, seed);
    EXPECT_GT(wander(0.2, seed), 100u) << "leaves that are split and come back";
  }
}

}  // namespace
