#include <algorithm>
#include <map>
#include <stdexcept>

#include "StreamPackets.h"

namespace semantic_octree {

struct MapReceiver::State {
  std::uint32_t stream = 0, sequence = 0;
  PacketHeader header;  ///< of the first packet of the revision that came
  std::vector<bool> came;
  std::vector<StreamPrefix> packets;  ///< their bytes and alphas
  std::size_t numCome = 0;
  std::uint32_t prefix = 0;
  std::vector<std::string> described;   ///< parts of the description
  std::vector<std::string> unreadable;  ///< packets that wait for the description
  bool isDescribed = false;
  std::uint32_t checksum = 0;

  StreamKind kind;
  StreamTree tree;
  std::multimap<CellPath, TreePart> waiting;  ///< octets whose cubes are not there yet, by these

  bool begin(const PacketHeader& h);
  /** If it fails, the packet has not come: what was placed is placed again, to no effect. */
  void store(const PacketHeader& h, const std::string& content);
  /** A part of it. */
  void describe(std::size_t number, const std::string& content);
  void apply(const std::string& content);
  void place(const TreePart& part);
  /** What waits for a cube, if that is there now. */
  void release(const CellPath& cell);
  void finish();
};

MapReceiver::MapReceiver(std::uint32_t stream) : m_state(std::make_unique<State>()) {
  m_state->stream = stream;
}
MapReceiver::~MapReceiver() = default;
MapReceiver::MapReceiver(MapReceiver&&) noexcept = default;

void MapReceiver::accept(const Datagram& data) {
  State& s = *m_state;
  if (data.stream != s.stream || data.type != Datagram::Type::Data)
    throw std::runtime_error("a datagram of stream " + std::to_string(data.stream) +
                             ", expected data of stream " + std::to_string(s.stream));
  const PacketHeader h = PacketHeader::of(data.payload);
  if (!s.begin(h)) return;
  s.sequence = std::max(s.sequence, h.sequence);
  if (s.came[h.number]) return;
  s.store(h, data.payload.substr(PacketHeader::kBytes));
  if (s.numCome == s.came.size()) s.finish();
}

/** \return whether the packet is of the present revision, which it may begin */
bool MapReceiver::State::begin(const PacketHeader& h) {
  if (h.revision < header.revision) return false;
  if (h.revision > header.revision) {
    if (h.revision > header.revision + 1 || numCome < came.size())
      throw std::runtime_error("altered: a change of a map that is not complete yet");
    std::vector<bool> none(h.count);
    std::vector<StreamPrefix> noPackets(h.count);
    described.assign(h.numDescription, {});
    came.swap(none);  // nothing fails from here on
    packets.swap(noPackets);
    header = h;
    numCome = prefix = 0;
    isDescribed = false;
  }
  if (h.count != header.count || h.numDescription != header.numDescription)
    throw std::runtime_error("altered: a packet's numbers differ from the others'");
  return true;
}

void MapReceiver::State::store(const PacketHeader& h, const std::string& content) {
  if (h.number < header.numDescription)
    describe(h.number, content);
  else if (isDescribed)
    apply(content);
  else
    unreadable.push_back(content);
  came[h.number] = true;
  ++numCome;
  packets[h.number].bytes = kHeaderBytes + content.size();
  if (h.isOptimal) packets[h.number].alpha = h.alpha;
  while (prefix < came.size() && came[prefix]) ++prefix;
}

void MapReceiver::State::describe(std::size_t number, const std::string& content) {
  described[number] = content;
  for (std::size_t i = 0; i < described.size(); ++i)
    if (!came[i] && i != number) return;
  std::string text;
  for (const std::string& part : described) text += part;
  const StreamDescription d = StreamDescription::of(text);
  if (header.revision == 1) {
    kind = d.read();
    tree = StreamTree();  // what was placed after another description, which failed
    waiting.clear();
  }
  kind.calibrate(d.stated);
  checksum = d.checksum;
  for (const std::string& packet : unreadable) apply(packet);
  unreadable.clear();
  isDescribed = true;
}

void MapReceiver::State::apply(const std::string& content) {
  for (const TreePart& part : kind.coder->decode(content)) place(part);
}

void MapReceiver::State::place(const TreePart& part) {
  if (!tree.apply(part, header.revision)) {
    waiting.emplace(part.cell, part);
  } else if (!part.isOctet) {
    release(part.cell);
  } else {
    for (int i = 0; i < 8; ++i)
      if (part.mask >> i & 1) release(part.cell.child(i));
  }
}

void MapReceiver::State::release(const CellPath& cell) {
  std::size_t n = waiting.count(cell);
  if (n > 0 && !tree.has(cell)) return;
  for (; n > 0; --n) {
    const auto first = waiting.find(cell);
    place(first->second);
    waiting.erase(first);
  }
}

void MapReceiver::State::finish() {
  if (waiting.empty() && checksumOf(tree.map(*kind.empty)) == checksum) return;
  throw std::runtime_error("altered: what came is not the sender's map");
}

Datagram MapReceiver::receipt() const {
  const State& s = *m_state;
  return {Datagram::Type::Receipt, s.stream,
          StreamReceipt::of(s.header.revision, s.sequence, s.came, s.prefix).bytes()};
}

bool MapReceiver::isComplete() const {
  return m_state->header.revision > 0 && m_state->numCome == m_state->came.size();
}
bool MapReceiver::isFinished() const { return isComplete() && m_state->header.isLast; }
bool MapReceiver::hasMap() const { return m_state->kind.empty != nullptr; }
std::size_t MapReceiver::numLeaves() const { return m_state->tree.numLeaves(); }
std::size_t MapReceiver::numPackets() const { return m_state->numCome; }
std::size_t MapReceiver::numExpected() const { return m_state->came.size(); }

SemanticOcTree MapReceiver::map() const {
  if (!hasMap()) throw std::logic_error("no map was received yet");
  return m_state->tree.map(*m_state->kind.empty);
}

StreamPrefix MapReceiver::prefix() const {
  const State& s = *m_state;
  StreamPrefix prefix;
  prefix.packets = s.prefix;
  for (std::size_t i = 0; i < s.prefix; ++i) prefix.bytes += s.packets[i].bytes;
  if (s.prefix > 0) prefix.alpha = s.packets[s.prefix - 1].alpha;
  return prefix;
}

}  // namespace semantic_octree
