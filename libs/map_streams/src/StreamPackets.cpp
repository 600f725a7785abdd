#include "StreamPackets.h"

#include <map_streams/MapStream.h>
#include <semantic_octree/TreeFile.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <deque>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <streambuf>

namespace semantic_octree {
namespace {

constexpr std::size_t kMaxBehind = 900;  // bytes
constexpr std::size_t kFixedBytes = 10;

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
  std::string bytes(kFixedBytes, '\0');
  std::memcpy(&bytes[0], &revision, 2);
  std::memcpy(&bytes[2], &sequence, 4);
  std::memcpy(&bytes[6], &prefix, 4);
  return bytes + behind;
}

StreamReceipt StreamReceipt::of(const std::string& bytes) {
  if (bytes.size() < kFixedBytes) throw std::runtime_error("altered: a receipt too short");
  StreamReceipt r;
  std::memcpy(&r.revision, &bytes[0], 2);
  std::memcpy(&r.sequence, &bytes[2], 4);
  std::memcpy(&r.prefix, &bytes[6], 4);
  r.behind = bytes.substr(kFixedBytes);
  return r;
}

namespace {

/** Appends, or takes from a place on. */
class Fields {
 public:
  explicit Fields(std::string& bytes, std::size_t next = 0) : m_bytes(bytes), m_next(next) {}
  template <typename T>
  void put(T value) {
    m_bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  template <typename T>
  T get() {
    if (m_bytes.size() - m_next < sizeof(T))
      throw std::runtime_error("altered: a packet too short");
    T value;
    std::memcpy(&value, m_bytes.data() + m_next, sizeof(T));
    m_next += sizeof(T);
    return value;
  }
  void putText(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size()));
    m_bytes += text;
  }
  std::string getText() {
    const auto size = get<std::uint32_t>();
    if (m_bytes.size() - m_next < size) throw std::runtime_error("altered: a packet too short");
    m_next += size;
    return m_bytes.substr(m_next - size, size);
  }

 private:
  std::string& m_bytes;
  std::size_t m_next;
};

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

/** The checksum of what is written into it. */
class Crc : public std::streambuf {
 public:
  std::uint32_t value() const { return static_cast<std::uint32_t>(m_crc); }

 protected:
  std::streamsize xsputn(const char* bytes, std::streamsize number) override {
    m_crc = crc32_z(m_crc, reinterpret_cast<const unsigned char*>(bytes),
                    static_cast<std::size_t>(number));
    return number;
  }
  int_type overflow(int_type byte) override {
    const char c = traits_type::to_char_type(byte);
    xsputn(&c, 1);
    return traits_type::not_eof(byte);
  }

 private:
  unsigned long m_crc = 0;
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
    for (std::size_t at = 0; at != m_parts.size();) {
      std::size_t end = at + numThatFit(at);
      for (std::size_t cut = end; cut != at; --cut)
        if (cut == m_parts.size() || m_parts.begins(cut)) {
          end = cut;
          break;
        }
      packets.push_back({m_coder.encode(m_window.sorted(at, end)), prefixBefore(end)});
      at = end;
    }
    return packets;
  }

 private:
  std::size_t sizeOf(std::size_t at, std::size_t number) {
    return m_coder.encode(m_window.sorted(at, at + number)).size();
  }
  /** Up to a 64th; one always does. */
  std::size_t numThatFit(std::size_t at) {
    const std::size_t most = std::min<std::size_t>(m_parts.size() - at, UINT16_MAX);
    std::size_t fits = 1, exceeds = most + 1;
    for (std::size_t n = m_last; exceeds - fits > 1 + fits / 64;) {
      n = std::clamp(n, fits + 1, exceeds - 1);
      const std::size_t size = sizeOf(at, n);
      (size <= m_maxBytes ? fits : exceeds) = n;
      n = n * m_maxBytes / std::max<std::size_t>(size, 1);
    }
    return m_last = fits;
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

}  // namespace

std::string PacketHeader::bytes() const {
  std::string text;
  Fields fields(text);
  fields.put(revision);
  fields.put(numDescription);
  fields.put(static_cast<std::uint8_t>((isLast ? kLastFlag : 0) | (isOptimal ? kOptimalFlag : 0)));
  fields.put(number);
  fields.put(count);
  fields.put(sequence);
  fields.put(alpha);
  return text;
}

PacketHeader PacketHeader::of(const std::string& payload) {
  std::string text = payload.substr(0, kBytes);
  Fields fields(text);
  PacketHeader h;
  h.revision = fields.get<std::uint16_t>();
  h.numDescription = fields.get<std::uint8_t>();
  const auto flags = fields.get<std::uint8_t>();
  h.isLast = flags & kLastFlag;
  h.isOptimal = flags & kOptimalFlag;
  h.number = fields.get<std::uint32_t>();
  h.count = fields.get<std::uint32_t>();
  h.sequence = fields.get<std::uint32_t>();
  h.alpha = fields.get<float>();
  const bool fine = h.revision > 0 && h.numDescription > 0 && h.numDescription <= h.count &&
                    h.number < h.count && h.count <= MapSender::kMaxPackets;
  if (!fine) throw std::runtime_error("altered: a packet's numbers cannot be");
  return h;
}

namespace {

double powerIn(Fields& fields) {
  const auto power = fields.get<double>();
  if (!(power > 0 && power <= 4)) throw std::runtime_error("altered: a power that cannot be");
  return power;
}

}  // namespace

std::string StreamDescription::compressed() const {
  std::string text;
  Fields fields(text);
  fields.put(checksum);
  fields.put(static_cast<std::uint8_t>(rootDepth));
  fields.putText(coding);
  fields.putText(kind);
  fields.put(power);
  uLongf size = compressBound(text.size());
  std::string packed(size, '\0');
  compress2(reinterpret_cast<Bytef*>(&packed[0]), &size,
            reinterpret_cast<const Bytef*>(text.data()), text.size(), Z_BEST_COMPRESSION);
  packed.resize(size);
  std::string result;
  Fields(result).put(static_cast<std::uint32_t>(text.size()));
  return result + packed;
}

StreamDescription StreamDescription::of(const std::string& compressed) {
  std::string packed = compressed;
  const auto expected = Fields(packed).get<std::uint32_t>();
  if (expected > kMaxDescription) throw std::runtime_error("altered: a description too long");
  std::string text(expected, '\0');
  uLongf size = expected;
  const auto* from = reinterpret_cast<const Bytef*>(packed.data()) + sizeof(expected);
  if (uncompress(reinterpret_cast<Bytef*>(&text[0]), &size, from,
                 packed.size() - sizeof(expected)) != Z_OK ||
      size != expected)
    throw std::runtime_error("altered: a description that cannot be unpacked");
  Fields fields(text);
  StreamDescription d;
  d.checksum = fields.get<std::uint32_t>();
  d.rootDepth = fields.get<std::uint8_t>();
  if (d.rootDepth > kTreeDepth) throw std::runtime_error("altered: trees below the voxels");
  d.coding = fields.getText();
  d.kind = fields.getText();
  d.power = powerIn(fields);
  return d;
}

std::string fileOf(const SemanticOcTree& map) {
  std::ostringstream out;
  writeTree(out, map);
  return out.str();
}

std::uint32_t checksumOf(const SemanticOcTree& map) {
  Crc crc;
  std::ostream out(&crc);
  writeTree(out, map);
  return crc.value();
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

/** CRC-32 of all that follows (4 bytes), "SO", version, type (1 byte), stream (4 bytes). */
constexpr char kMark[] = {'S', 'O'};
constexpr std::uint8_t kStreamVersion = 3;
constexpr std::size_t kDatagramHeaderBytes = 12;

std::uint32_t crcOf(const std::string& bytes, std::size_t from) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data()) + from, bytes.size() - from));
}

}  // namespace

std::string Datagram::bytes() const {
  std::string bytes(kDatagramHeaderBytes, '\0');
  std::memcpy(&bytes[4], kMark, sizeof(kMark));
  bytes[6] = static_cast<char>(kStreamVersion);
  bytes[7] = static_cast<char>(type);
  std::memcpy(&bytes[8], &stream, sizeof(stream));
  bytes += payload;
  const std::uint32_t crc = crcOf(bytes, sizeof(crc));
  std::memcpy(&bytes[0], &crc, sizeof(crc));
  return bytes;
}

Datagram Datagram::of(const std::string& bytes) {
  if (bytes.size() < kDatagramHeaderBytes || bytes.size() > kMaxDatagramBytes ||
      std::memcmp(&bytes[4], kMark, sizeof(kMark)) != 0)
    throw std::runtime_error("a datagram of another program");
  std::uint32_t crc = 0;
  std::memcpy(&crc, &bytes[0], sizeof(crc));
  if (crc != crcOf(bytes, sizeof(crc)))
    throw std::runtime_error("altered: a datagram whose checksum does not match");
  if (const auto version = static_cast<std::uint8_t>(bytes[6]); version != kStreamVersion)
    throw std::runtime_error("a datagram of version " + std::to_string(version) +
                             " of the protocol, expected " + std::to_string(kStreamVersion));
  Datagram d;
  d.type = static_cast<Type>(bytes[7]);
  if (d.type < Type::Request || d.type > Type::Cookie)
    throw std::runtime_error("altered: a datagram of type " +
                             std::to_string(static_cast<std::uint8_t>(bytes[7])));
  std::memcpy(&d.stream, &bytes[8], sizeof(d.stream));
  d.payload = bytes.substr(kDatagramHeaderBytes);
  return d;
}

namespace {
constexpr char kTreeMark[] = {'S', 'O', 'T', 1};  // the last one is the version
}

std::string TreeMessage::bytes() const {
  std::string bytes(sizeof(std::uint32_t), '\0');
  bytes.append(kTreeMark, sizeof(kTreeMark));
  Fields fields(bytes);
  fields.put(stream);
  fields.put(number);
  fields.put(static_cast<std::uint8_t>(isAll));
  fields.putText(description);
  fields.put(power);
  fields.put(static_cast<std::uint32_t>(parts.size()));
  for (const std::string& group : parts) fields.putText(group);
  const std::uint32_t crc = crcOf(bytes, sizeof(crc));
  std::memcpy(&bytes[0], &crc, sizeof(crc));
  return bytes;
}

TreeMessage TreeMessage::of(const std::string& bytes) {
  std::string text = bytes;
  Fields fields(text);
  const auto crc = fields.get<std::uint32_t>();
  for (const char c : kTreeMark)
    if (fields.get<char>() != c)
      throw std::runtime_error("no change of a compressed tree, or one of another version");
  if (crc != crcOf(text, sizeof(crc)))
    throw std::runtime_error("altered: a change whose checksum does not match");
  TreeMessage m;
  m.stream = fields.get<std::uint32_t>();
  m.number = fields.get<std::uint32_t>();
  m.isAll = fields.get<std::uint8_t>() != 0;
  m.description = fields.getText();
  m.power = powerIn(fields);
  for (auto groups = fields.get<std::uint32_t>(); groups > 0; --groups)
    m.parts.push_back(fields.getText());
  return m;
}

}  // namespace semantic_octree
