#include <semantic_abstraction/Abstraction.h>

#include <algorithm>
#include <deque>
#include <stdexcept>
#include <utility>

#include "StreamPackets.h"

namespace semantic_octree {
namespace {

constexpr std::size_t kMaxDescriptionPackets = 255;

struct Packet : PacketContent {
  bool hasCome = false, isQueued = false;
  std::uint32_t sequence = 0;  ///< when it was sent last; 0: never
};

}  // namespace

struct MapSender::State {
  std::uint32_t stream;
  PacketHeader header;                   ///< of the present revision
  StreamTree told;                       ///< what the receiver will have; of the last map: nothing
  std::unique_ptr<SemanticOcTree> kind;  ///< an empty map
  std::unique_ptr<PartCoder> coder;
  std::vector<Packet> packets;
  std::vector<StreamPrefix> prefixes;
  std::size_t numCome = 0, numNew = 0;  ///< packets that came; that were sent at all
  std::deque<std::size_t> lost;
  std::uint32_t heard = 0;  ///< the latest sequence that a receipt told of

  std::vector<Packet> description(const SemanticOcTree& compressed, const PartCoder& with,
                                  const SemanticOcTree& like) const;
  void take(std::vector<Packet> all, std::size_t numDescription);
  void checkNext(const SemanticOcTree& empty, int rootDepth) const;
  void countPrefixes();
  void lose(std::size_t number);
};

MapSender::MapSender(std::uint32_t stream) : m_state(std::make_unique<State>()) {
  m_state->stream = stream;
}
MapSender::~MapSender() = default;
MapSender::MapSender(MapSender&&) noexcept = default;

void MapSender::State::checkNext(const SemanticOcTree& empty, int rootDepth) const {
  if (kind && *kind != empty)
    throw std::invalid_argument(
        "the next map differs from the one before in resolution, filter or class table");
  if (coder && coder->rootDepth() != rootDepth)
    throw std::invalid_argument("the next map's blocks are not those of the one before");
}

/** Parts, packets and the compressed tree take as much memory as each other: the first are gone
 * when the last is made. */
void MapSender::setMap(SemanticOcTree& map, bool isLast) {
  State& s = *m_state;
  if (!isComplete()) throw std::logic_error("the receiver does not have the map before yet");
  if (s.header.isLast) throw std::logic_error("a map behind the last one");
  const Abstraction abstraction(map);
  auto kind = std::make_unique<SemanticOcTree>(abstraction.emptyCompressedMap());
  s.checkNext(*kind, abstraction.rootDepth());
  auto parts = std::make_unique<TreeParts>(partsOfChange(map, s.told));
  auto coder = std::make_unique<PartCoder>(
      s.coder ? *s.coder : coderFor(*parts, map.numClasses(), abstraction.rootDepth()));
  std::vector<PacketContent> data = packetsOf(*parts, *coder, kMaxContent);
  StreamTree told = isLast ? StreamTree() : s.told;
  for (std::size_t i = 0; !isLast && i < parts->parts.size(); ++i)
    told.apply(parts->parts.part(i), s.header.revision + 1u);
  parts = nullptr;
  std::vector<Packet> all = s.description(abstraction.compressedMap(), *coder, *kind);
  const std::size_t numDescription = all.size();
  for (PacketContent& content : data) all.push_back({std::move(content)});
  if (all.size() > kMaxPackets)
    throw std::invalid_argument("a map of " + std::to_string(all.size()) +
                                " packets is too large to be sent");
  s.kind = std::move(kind);
  s.coder = std::move(coder);
  s.told = std::move(told);
  s.header.isLast = isLast;
  s.take(std::move(all), numDescription);
}

/** What is told before the parts: of the first map how it is coded, too. */
std::vector<Packet> MapSender::State::description(const SemanticOcTree& compressed,
                                                  const PartCoder& with,
                                                  const SemanticOcTree& like) const {
  StreamDescription d;
  d.checksum = checksumOf(compressed);
  d.stated = compressed.filterParameters().calibration;
  d.rootDepth = static_cast<std::uint8_t>(with.rootDepth());
  if (header.revision == 0) {
    d.coding = with.toText();
    d.kind = fileOf(like);
  }
  const std::string text = d.compressed();
  std::vector<Packet> described;
  for (std::size_t at = 0; at < text.size(); at += kMaxContent)
    described.push_back({{text.substr(at, kMaxContent), {}}});
  if (described.size() > kMaxDescriptionPackets)
    throw std::invalid_argument("a class table too long to be sent");
  return described;
}

void MapSender::State::take(std::vector<Packet> all, std::size_t numDescription) {
  packets = std::move(all);
  ++header.revision;
  header.numDescription = static_cast<std::uint8_t>(numDescription);
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
    prefixes.back().bytes = bytes += kHeaderBytes + packet.bytes.size();
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
  return Datagram{Datagram::Type::Data, s.stream, s.header.bytes() + packet.bytes};
}

void MapSender::State::lose(std::size_t number) {
  Packet& packet = packets[number];
  if (packet.hasCome || packet.isQueued || packet.sequence == 0) return;
  packet.isQueued = true;
  lost.push_back(number);
}

bool MapSender::accept(const Datagram& receipt) {
  State& s = *m_state;
  if (receipt.stream != s.stream || receipt.type != Datagram::Type::Receipt)
    throw std::runtime_error("a datagram of stream " + std::to_string(receipt.stream) +
                             ", expected a receipt of stream " + std::to_string(s.stream));
  const StreamReceipt r = StreamReceipt::of(receipt.payload);
  if (r.revision != s.header.revision) return false;
  bool isNew = r.sequence > std::exchange(s.heard, std::max(s.heard, r.sequence));
  const std::size_t known = std::min(s.packets.size(), r.numPackets());
  for (std::size_t i = 0; i < known; ++i) {
    Packet& packet = s.packets[i];
    if (r.has(i) && !packet.hasCome) {
      packet.hasCome = isNew = true;
      ++s.numCome;
    }
    if (!r.has(i) && packet.sequence <= r.sequence) s.lose(i);
  }
  return isNew;
}

void MapSender::repeat() {
  for (std::size_t i = 0; i < m_state->packets.size(); ++i) m_state->lose(i);
}

bool MapSender::isComplete() const { return m_state->numCome == m_state->packets.size(); }

const std::vector<StreamPrefix>& MapSender::prefixes() const { return m_state->prefixes; }

}  // namespace semantic_octree
