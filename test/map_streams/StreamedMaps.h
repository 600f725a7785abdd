#pragma once
#include <map_streams/MapStream.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/TreeFile.h>

#include "RandomScans.h"
#include "StreamPackets.h"
#include "ThreeTerms.h"

/** Maps to be sent, and their packets. */
namespace streamed_maps {

using namespace semantic_octree;

constexpr int K = 6;
constexpr std::uint32_t kStream = 0x5eed;

inline AbstractionOptions someOptions(double alpha) { return threeTerms(alpha, K, 0.2); }

inline SemanticOcTree mapOf(const std::vector<PosedCloud>& scans,
                            const AbstractionOptions& options) {
  SemanticOcTree map(0.2, numberedClasses(K));
  setAbstraction(map, options);
  for (const PosedCloud& s : scans) map.insert(s.cloud, s.T_map_sensor);
  return map;
}

inline SemanticOcTree smallPlace(const AbstractionOptions& options, unsigned seed = 7) {
  return mapOf(scansOfSmallPlace(3, 2500, K, seed), options);
}

inline SemanticOcTree randomMap(const AbstractionOptions& options, unsigned seed) {
  std::mt19937 random(seed);
  RandomScanOptions scans;
  scans.classes = K;
  return mapOf({randomScan(random, scans), randomScan(random, scans)}, options);
}

/** All packets, each once. */
inline std::vector<Datagram> packetsOf(MapSender& sender) {
  std::vector<Datagram> packets;
  while (auto packet = sender.next()) packets.push_back(*packet);
  return packets;
}

}  // namespace streamed_maps
