#include "StreamPackets.h"

#include <map_streams/MapStream.h>
#include <semantic_octree/TreeFile.h>
#include <semantic_octree/store/TreeFormat.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <deque>
#include <sstream>
#include <stdexcept>

#include "Bytes.h"

namespace semantic_octree {
namespace {

constexpr std::size_t kMaxBehind = 900;  // bytes

template <class Bytes, class Receipt>
void codeReceipt(Bytes& bytes, Receipt& r) {
  bytes.value(r.revision);
  bytes.value(r.sequence);
  bytes.value(r.prefix);
}

}  // namespace

StreamReceipt StreamReceipt::of(std::uint16_t revision, std::uint32_t sequence,
                                const std::vector<bool>& came, std::uint32_t prefix) {
  StreamReceipt r;
  r.revision = revision;
  r.sequence = sequence;
  r.prefix = prefix;
  const std::size_t end = std::min(came.size(), prefix + 8 * kMaxBehind);
  r.behind.assign((end - prefix + 7) / 8, '\0');
  for (std::size_t i = prefix; i < end; ++i)
    if (came[i]) r.behind[(i - prefix) / 8] |= static_cast<char>(1 << (i - prefix) % 8);
  while (!r.behind.empty() && r.behind.back() == 0) r.behind.pop_back();
  return r;
}

std::string StreamReceipt::bytes() const {
  ByteWriter writer;
  codeReceipt(writer, *this);
  return writer.bytes + behind;
}

StreamReceipt StreamReceipt::of(const std::string& bytes) {
  ByteReader reader(bytes);
  StreamReceipt r;
  codeReceipt(reader, r);
  r.behind = reader.rest();
  return r;
}

namespace {

constexpr std::uint8_t kLastFlag = 1, kOptimalFlag = 2;
constexpr std::uint32_t kMaxDescription = 1 << 24;

/** Some of a list's parts in a row, unpacked. */
class PartWindow {
 public:
  explicit PartWindow(const PartList& parts) : m_parts(parts) {}

  /** Valid until the next call. \param begin, end neither before those of the last call's */
  std::vector<const TreePart*> sorted(std::size_t begin, std::size_t end) {
    for (; m_begin < begin && !m_unpacked.empty(); ++m_begin) m_unpacked.pop_front();
    m_begin = begin;
    while (m_begin + m_unpacked.size() < end)
      m_unpacked.push_back(m_parts.part(m_begin + m_unpacked.size()));
    std::vector<const TreePart*> parts;
    for (std::size_t i = begin; i < end; ++i) parts.push_back(&m_unpacked[i - begin]);
    std::stable_sort(parts.begin(), parts.end(),
                     [](const TreePart* a, const TreePart* b) { return a->cell < b->cell; });
    return parts;
  }

 private:
  const PartList& m_parts;
  std::size_t m_begin = 0;
  std::deque<TreePart> m_unpacked;  ///< from there on
};

/** Fills packets, one behind the other. */
class Packer {
 public:
  Packer(const TreeParts& parts, const PartCoder& coder, std::size_t maxBytes)
      : m_parts(parts.parts),
        m_all(parts),
        m_window(parts.parts),
        m_coder(coder),
        m_maxBytes(maxBytes) {}

  std::vector<PacketContent> packets() {
    std::vector<PacketContent> packets;
    for (std::size_t at = 0; at != m_parts.size();) packets.push_back(packetAt(at));
    return packets;
  }

 private:
  std::string encoded(std::size_t at, std::size_t end) {
    return m_coder.encode(m_window.sorted(at, end));
  }
  /** As many parts as fit, nearly. \param at the first, then the first behind them */
  PacketContent packetAt(std::size_t& at) {
    PacketContent packet;
    std::size_t end = endOf(at, numThatFit(at));
    while ((packet.bytes = encoded(at, end)).size() > m_maxBytes && end > at + 1)
      end = endOf(at, end - at - 1);
    at = end;
    packet.prefix = prefixBefore(at);
    return packet;
  }
  /** Up to a 32nd; one always does. */
  std::size_t numThatFit(std::size_t at) {
    const std::size_t most = std::min<std::size_t>(m_parts.size() - at, UINT16_MAX);
    std::size_t fits = 1, exceeds = most + 1;
    for (std::size_t n = m_last; exceeds - fits > 1 + fits / 32;) {
      n = std::clamp(n, fits + 1, exceeds - 1);
      const std::size_t size = encoded(at, at + n).size();
      (size <= m_maxBytes ? fits : exceeds) = n;
      n = n * m_maxBytes / size;
    }
    return m_last = fits;
  }
  /** Behind at most so many parts, if possible where something begins. */
  std::size_t endOf(std::size_t at, std::size_t number) const {
    const std::size_t last = at + std::min({number, m_parts.size() - at, std::size_t(UINT16_MAX)});
    for (std::size_t end = last; end != at; --end)
      if (end == m_parts.size() || m_parts.begins(end)) return end;
    return last;
  }
  StreamPrefix prefixBefore(std::size_t end) const {
    StreamPrefix prefix;
    const bool isEnd = end == m_parts.size();
    const std::size_t step = m_parts.step(end - 1);
    prefix.isWhole = isEnd || m_parts.step(end) != step;
    const bool isOptimal = isEnd || (m_parts.begins(end) && (step > 0 || prefix.isWhole));
    if (!isOptimal) return prefix;
    if (isEnd)
      prefix.alpha = m_all.alphas.back();
    else
      prefix.alpha = prefix.isWhole ? m_all.alphas[step] : m_all.ties[step];
    return prefix;
  }

  const PartList& m_parts;
  const TreeParts& m_all;
  PartWindow m_window;
  const PartCoder& m_coder;
  std::size_t m_maxBytes, m_last = 64;
};

template <class Bytes>
void codeHeader(Bytes& bytes, PacketHeader& h) {
  auto flags =
      static_cast<std::uint8_t>((h.isLast ? kLastFlag : 0) | (h.isOptimal ? kOptimalFlag : 0));
  bytes.value(h.revision);
  bytes.value(h.numDescription);
  bytes.value(flags);
  bytes.value(h.number);
  bytes.value(h.count);
  bytes.value(h.sequence);
  bytes.value(h.alpha);
  h.isLast = flags & kLastFlag;
  h.isOptimal = flags & kOptimalFlag;
}

}  // namespace

std::string PacketHeader::bytes() const {
  ByteWriter writer;
  PacketHeader copy = *this;
  codeHeader(writer, copy);
  return writer.bytes;
}

PacketHeader PacketHeader::of(const std::string& payload) {
  ByteReader reader(payload);
  PacketHeader h;
  codeHeader(reader, h);
  const bool fine = h.revision > 0 && h.numDescription > 0 && h.numDescription <= h.count &&
                    h.number < h.count && h.count <= MapSender::kMaxPackets;
  if (!fine) throw std::runtime_error("altered: a packet's numbers cannot be");
  return h;
}

namespace {

template <class Bytes, class Description>
void codeDescription(Bytes& bytes, Description& d) {
  bytes.value(d.checksum);
  bytes.value(d.rootDepth);
  bytes.text(d.coding);
  bytes.text(d.kind);
  bytes.value(d.stated.power);
}

}  // namespace

std::string StreamDescription::compressed() const {
  ByteWriter plain;
  codeDescription(plain, *this);
  if (!stated.factors.empty()) plain.list(stated.factors);
  return packed(plain.bytes);
}

StreamDescription StreamDescription::of(const std::string& compressed) {
  const std::string plain = unpacked(compressed, kMaxDescription);
  ByteReader reader(plain);
  StreamDescription d;
  codeDescription(reader, d);
  if (d.rootDepth > kTreeDepth) throw std::runtime_error("altered: trees below the voxels");
  if (!reader.rest().empty()) reader.list(d.stated.factors);
  return d;
}

void StreamKind::calibrate(const Calibration& stated) {
  try {
    empty->setCalibration(stated);
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(std::string("altered: ") + e.what());
  }
}

StreamKind StreamDescription::read() const {
  std::istringstream in(kind);
  StreamKind read;
  read.empty = std::make_unique<SemanticOcTree>(readTree(in));
  if (!read.empty->empty()) throw std::runtime_error("altered: a description that holds a map");
  read.coder = std::make_unique<PartCoder>(read.empty->numClasses(), rootDepth);
  read.coder->fromText(coding);
  return read;
}

std::string fileOf(const SemanticOcTree& map) {
  std::ostringstream out;
  writeTree(out, map);
  return out.str();
}

std::uint32_t checksumOf(const SemanticOcTree& map) {
  const std::string file = fileOf(map);
  return extendCrc(0, file.data(), file.size());
}

std::vector<PacketContent> packetsOf(const TreeParts& parts, const PartCoder& coder,
                                     std::size_t maxBytes) {
  return Packer(parts, coder, maxBytes).packets();
}

PartCoder coderFor(const TreeParts& parts, int numClasses, int rootDepth) {
  constexpr std::size_t kPerGroup = 128;  // about a packet's
  PartCoder coder(numClasses, rootDepth);
  coder.learn([&](const PartCoder::VisitGroup& visit) {
    PartWindow window(parts.parts);
    for (std::size_t at = 0; at < parts.parts.size(); at += kPerGroup)
      visit(window.sorted(at, std::min(at + kPerGroup, parts.parts.size())));
  });
  return coder;
}

namespace {

/** A datagram: CRC-32 of all that follows (4 bytes), "SO", version, type (1 byte), stream (4
 * bytes), payload. */
using DatagramMark = std::array<char, 2>;
constexpr DatagramMark kMark{'S', 'O'};
constexpr std::uint8_t kStreamVersion = 4;
constexpr std::size_t kDatagramHeaderBytes = 12;

std::uint32_t crcOf(const std::string& bytes) {  // behind its place
  return extendCrc(0, bytes.data() + sizeof(std::uint32_t), bytes.size() - sizeof(std::uint32_t));
}

/** \param bytes with room for the checksum, which is filled */
std::string checked(std::string bytes) {
  const std::uint32_t crc = crcOf(bytes);
  std::memcpy(&bytes[0], &crc, sizeof(crc));
  return bytes;
}

}  // namespace

std::string Datagram::bytes() const {
  ByteWriter writer;
  writer.value(std::uint32_t(0));  // the checksum
  writer.value(kMark);
  writer.value(kStreamVersion);
  writer.value(type);
  writer.value(stream);
  return checked(writer.bytes + payload);
}

Datagram Datagram::of(const std::string& bytes) {
  if (bytes.size() < kDatagramHeaderBytes || bytes.size() > kMaxDatagramBytes ||
      bytes.compare(4, kMark.size(), kMark.data(), kMark.size()) != 0)
    throw std::runtime_error("a datagram of another program");
  ByteReader reader(bytes);
  if (reader.take<std::uint32_t>() != crcOf(bytes))
    throw std::runtime_error("altered: a datagram whose checksum does not match");
  reader.take<DatagramMark>();
  if (const auto version = reader.take<std::uint8_t>(); version != kStreamVersion)
    throw std::runtime_error("a datagram of version " + std::to_string(version) +
                             " of the protocol, expected " + std::to_string(kStreamVersion));
  Datagram d;
  reader.value(d.type);
  if (d.type < Type::Request || d.type > Type::Cookie)
    throw std::runtime_error("altered: a datagram of type " +
                             std::to_string(static_cast<std::uint8_t>(d.type)));
  reader.value(d.stream);
  d.payload = reader.rest();
  return d;
}

namespace {

using TreeMark = std::array<char, 4>;
// The last one is the version: 4 where classes have factors.
constexpr TreeMark kTreeMark{'S', 'O', 'T', 3}, kFactorsMark{'S', 'O', 'T', 4};

template <class Bytes, class Message>
void codeMessage(Bytes& bytes, Message& m) {
  bytes.value(m.stream);
  bytes.value(m.number);
  bytes.flag(m.isAll);
  bytes.text(m.description);
  bytes.value(m.stated.power);
}

}  // namespace

std::string TreeMessage::bytes() const {
  ByteWriter writer;
  writer.value(std::uint32_t(0));  // the checksum
  writer.value(stated.factors.empty() ? kTreeMark : kFactorsMark);
  codeMessage(writer, *this);
  if (!stated.factors.empty()) writer.list(stated.factors);
  writer.value(static_cast<std::uint32_t>(parts.size()));
  for (const std::string& group : parts) writer.text(group);
  return checked(std::move(writer.bytes));
}

TreeMessage TreeMessage::of(const std::string& bytes) {
  ByteReader reader(bytes);
  const auto crc = reader.take<std::uint32_t>();
  const auto mark = reader.take<TreeMark>();
  if (mark != kTreeMark && mark != kFactorsMark)
    throw std::runtime_error("no change of a compressed tree, or one of another version");
  if (crc != crcOf(bytes))
    throw std::runtime_error("altered: a change whose checksum does not match");
  TreeMessage m;
  codeMessage(reader, m);
  if (mark == kFactorsMark) reader.list(m.stated.factors);
  for (auto groups = reader.take<std::uint32_t>(); groups > 0; --groups)
    reader.text(m.parts.emplace_back());
  return m;
}

}  // namespace semantic_octree
