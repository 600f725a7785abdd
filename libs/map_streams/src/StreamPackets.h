#pragma once
#include <map_streams/MapStream.h>

#include <cstdint>
#include <string>
#include <vector>

#include "PartCoder.h"
#include "TreeParts.h"

namespace semantic_octree {

/** What came of a revision: all packets up to one, and which of those behind it. */
struct StreamReceipt {
  std::uint16_t revision = 0;  ///< 0: nothing at all
  std::uint32_t sequence = 0;  ///< the highest that came
  std::uint32_t prefix = 0;    ///< so many from the first on
  std::string behind;          ///< a bit each, the lowest first

  bool has(std::size_t number) const {
    if (number < prefix) return true;
    const std::size_t i = number - prefix;
    return i / 8 < behind.size() && (behind[i / 8] >> i % 8 & 1);
  }
  /** The packets that it speaks of, from the first on. */
  std::size_t numPackets() const { return prefix + 8 * behind.size(); }

  /** A receipt of the prefix and of the 7200 packets behind it, which fit into a datagram. */
  static StreamReceipt of(std::uint16_t revision, std::uint32_t sequence,
                          const std::vector<bool>& came, std::uint32_t prefix);
  std::string bytes() const;
  /** \throw std::runtime_error too short. */
  static StreamReceipt of(const std::string& bytes);
};

/** Begins a Data datagram's payload, before the packet's own bytes. Little endian, without gaps. */
struct PacketHeader {
  std::uint16_t revision = 0;           ///< 1: the first map, 2: its first change, ...
  std::uint8_t numDescription = 0;      ///< so many packets from the first on are its description
  bool isLast = false;                  ///< of the stream
  bool isOptimal = false;               ///< the prefix up to here, for `alpha`
  std::uint32_t number = 0, count = 0;  ///< of the packet, from 0; of all
  std::uint32_t sequence = 0;           ///< how many were sent up to now, repetitions counted
  float alpha = 0;

  static constexpr std::size_t kBytes = 20;
  std::string bytes() const;
  /** \throw std::runtime_error what cannot be. */
  static PacketHeader of(const std::string& payload);
};

/** Bytes of a datagram's and of a packet's header; for what is behind them. */
constexpr std::size_t kHeaderBytes = 12 + PacketHeader::kBytes;
constexpr std::size_t kMaxContent = kMaxDatagramBytes - kHeaderBytes;

/** The kind of a tree's maps, and the coder of its parts. */
struct StreamKind {
  std::unique_ptr<SemanticOcTree> empty;
  std::unique_ptr<PartCoder> coder;

  /** \throw std::runtime_error altered. */
  void calibrate(const Calibration& stated);
};

/** What is told before the parts: of the first map which classes it has, how its parts are coded,
 * and of each a checksum of its file. */
struct StreamDescription {
  std::uint32_t checksum = 0;
  std::uint8_t rootDepth = 0;
  std::string coding;  ///< PartCoder::toText()
  std::string kind;    ///< an empty map as a file
  Calibration stated;  ///< how the map's classes are

  std::string compressed() const;
  /** \throw std::runtime_error altered. */
  static StreamDescription of(const std::string& compressed);
  /** What it says of `coding` and `kind`. \throw std::runtime_error altered. */
  StreamKind read() const;
};

/** What TreeBroadcast tells at once. */
struct TreeMessage {
  std::uint32_t stream = 0, number = 0;  ///< the tree is then that of so many changes
  bool isAll = false;                    ///< what it tells is all that there is
  std::string description;               ///< from here on; empty: the one before
  Calibration stated;                    ///< how the tree's classes are
  std::vector<std::string> parts;        ///< as a PartCoder writes them

  std::string bytes() const;
  /** \throw std::runtime_error of another program, or altered. */
  static TreeMessage of(const std::string& bytes);
};

/** CRC-32 of a map's file. */
std::uint32_t checksumOf(const SemanticOcTree& map);
std::string fileOf(const SemanticOcTree& map);

/** What stands in a packet behind its header. */
struct PacketContent {
  std::string bytes;
  StreamPrefix prefix;  ///< without its numbers of packets and bytes
};

/** Parts, in order, as packets of at most so many bytes. They end where optimal trees do, unless
 * one packet cannot hold what belongs together. */
std::vector<PacketContent> packetsOf(const TreeParts& parts, const PartCoder& coder,
                                     std::size_t maxBytes);
/** A coder that has learned from these. */
PartCoder coderFor(const TreeParts& parts, int numClasses, int rootDepth);

}  // namespace semantic_octree
