#include <semantic_octree/Abstraction.h>

#include <algorithm>
#include <cstring>
#include <deque>
#include <stdexcept>

#include "StreamPackets.h"
#include "StreamReceipt.h"

namespace semantic_octree {
namespace {

constexpr std::size_t kMaxDescriptionPackets = 255;

struct Packet {
  std::string content;
  StreamPrefix prefix;
  bool hasCome = false, isQueued = false;
  std::uint32_t sequence = 0;  ///< when it was sent last; 0: never
};

}  // namespace

struct MapSender::State {
  std::uint32_t stream;
  PacketHeader header;  ///< of the present revision
  StreamTree told;
  std::unique_ptr<SemanticOcTree> kind;  ///< an empty map
  std::unique_ptr<PartCoder> coder;
  std::vector<Packet> packets;
  std::vector<StreamPrefix> prefixes;
  std::size_t numCome = 0, numNew = 0;  ///< packets that came; that were sent at all
  std::deque<std::size_t> lost;

  void describe(const SemanticOcTree& compressed, int rootDepth);
  void take(TreeParts parts);
  void countPrefixes();
  void lose(std::size_t number);
};

MapSender::MapSender(std::uint32_t stream) : m_state(std::make_unique<State>()) {
  m_state->stream = stream;
}
MapSender::~MapSender() = default;
MapSender::MapSender(MapSender&&) noexcept = default;

void MapSender::setMap(SemanticOcTree& map, bool isLast) {
  State& s = *m_state;
  if (!isComplete()) throw std::logic_error("the receiver does not have the map before yet");
  const Abstraction abstraction(map);
  const SemanticOcTree empty(map.getResolution(), map.classes(), map.filterParameters());
  if (s.kind && *s.kind != empty)
    throw std::invalid_argument(
        "the next map differs from the one before in resolution, filter or class table");
  if (s.coder && s.coder->rootDepth() != abstraction.rootDepth())
    throw std::invalid_argument("the next map's blocks are not those of the one before");
  TreeParts parts = partsOfChange(map, s.told);
  if (!s.kind) {
    s.kind = std::make_unique<SemanticOcTree>(empty);
    s.coder =
        std::make_unique<PartCoder>(coderFor(parts, map.numClasses(), abstraction.rootDepth()));
  }
  ++s.header.revision;
  s.header.isLast = isLast;
  s.packets.clear();
  s.describe(abstraction.compressedMap(), abstraction.rootDepth());
  s.take(std::move(parts));
}

/** \param compressed what is sent */
void MapSender::State::describe(const SemanticOcTree& compressed, int rootDepth) {
  StreamDescription d;
  d.checksum = checksumOf(compressed);
  d.rootDepth = rootDepth;
  if (header.revision == 1) {
    d.coding = coder->toText();
    d.kind = fileOf(*kind);
  }
  const std::string text = d.compressed();
  for (std::size_t at = 0; at < text.size(); at += kMaxContent) {
    packets.emplace_back();
    packets.back().content = text.substr(at, kMaxContent);
  }
  if (packets.size() > kMaxDescriptionPackets)
    throw std::invalid_argument("a class table too long to be sent");
  header.numDescription = static_cast<std::uint8_t>(packets.size());
}

void MapSender::State::take(TreeParts parts) {
  for (PacketContent& packet : packetsOf(parts, *coder, kMaxContent)) {
    packets.emplace_back();
    packets.back().content = std::move(packet.bytes);
    packets.back().prefix = packet.prefix;
  }
  if (packets.size() > kMaxPackets)
    throw std::invalid_argument("a map of " + std::to_string(packets.size()) +
                                " packets is too large to be sent");
  for (const OrderedPart& ordered : parts.parts) told.apply(ordered.part, header.revision);
  header.count = static_cast<std::uint32_t>(packets.size());
  numCome = numNew = 0;
  lost.clear();
  countPrefixes();
}

void MapSender::State::countPrefixes() {
  prefixes.clear();
  std::size_t bytes = 0;
  for (const Packet& packet : packets) {
    prefixes.push_back(packet.prefix);
    prefixes.back().packets = prefixes.size();
    prefixes.back().bytes = bytes += kHeaderBytes + packet.content.size();
  }
}

std::optional<Datagram> MapSender::next() {
  State& s = *m_state;
  while (!s.lost.empty() && s.packets[s.lost.front()].hasCome) s.lost.pop_front();
  std::size_t number = s.numNew;
  if (!s.lost.empty()) {
    number = s.lost.front();
    s.lost.pop_front();
  } else if (s.numNew == s.packets.size()) {
    return std::nullopt;
  } else {
    ++s.numNew;
  }
  Packet& packet = s.packets[number];
  packet.isQueued = false;
  packet.sequence = ++s.header.sequence;
  s.header.number = static_cast<std::uint32_t>(number);
  s.header.isOptimal = packet.prefix.alpha.has_value();
  s.header.alpha = static_cast<float>(packet.prefix.alpha.value_or(0));
  return Datagram{Datagram::Type::Data, s.stream, s.header.bytes() + packet.content};
}

void MapSender::State::lose(std::size_t number) {
  Packet& packet = packets[number];
  if (packet.hasCome || packet.isQueued || packet.sequence == 0) return;
  packet.isQueued = true;
  lost.push_back(number);
}

void MapSender::accept(const Datagram& receipt) {
  State& s = *m_state;
  if (receipt.stream != s.stream || receipt.type != Datagram::Type::Receipt)
    throw std::runtime_error("a datagram of stream " + std::to_string(receipt.stream) +
                             ", expected a receipt of stream " + std::to_string(s.stream));
  const StreamReceipt r = StreamReceipt::of(receipt.payload);
  if (r.revision != s.header.revision) return;
  const std::size_t known = std::min(s.packets.size(), r.numPackets());
  for (std::size_t i = 0; i < known; ++i) {
    Packet& packet = s.packets[i];
    if (r.has(i) && !packet.hasCome) {
      packet.hasCome = true;
      ++s.numCome;
    }
    if (!r.has(i) && packet.sequence <= r.sequence) s.lose(i);
  }
}

void MapSender::repeat() {
  for (std::size_t i = 0; i < m_state->packets.size(); ++i) m_state->lose(i);
}

bool MapSender::isComplete() const { return m_state->numCome == m_state->packets.size(); }

const std::vector<StreamPrefix>& MapSender::prefixes() const { return m_state->prefixes; }

}  // namespace semantic_octree
