#pragma once
#include <gtest/gtest.h>
#include <semantic_abstraction/Abstraction.h>

#include <algorithm>

#include "StreamedMaps.h"

namespace streamed_maps {

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
  /** Datagrams that come now, in any order; some stay for later. */
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
inline void expectValid(const SemanticOcTree& tree, const SemanticOcTree& map) {
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const SemanticOcTreeNode node = map.search(leaf.getKey(), leaf.getDepth());
    ASSERT_TRUE(node);
    ASSERT_EQ(leaf->getLogOdds(), node->getLogOdds());
  }
}

/** Lets both talk until the receiver has the map. \return datagrams that the sender sent */
inline std::size_t transmit(MapSender& sender, MapReceiver& receiver, Radio& there, Radio& back,
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

}  // namespace streamed_maps
