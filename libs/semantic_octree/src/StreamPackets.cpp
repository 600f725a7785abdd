#include "StreamPackets.h"

#include <semantic_octree/TreeFile.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <sstream>
#include <stdexcept>

namespace semantic_octree {
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

using Iterator = std::vector<OrderedPart>::const_iterator;

std::vector<const TreePart*> sorted(Iterator begin, Iterator end) {
  std::vector<const TreePart*> parts;
  for (; begin != end; ++begin) parts.push_back(&begin->part);
  std::stable_sort(parts.begin(), parts.end(),
                   [](const TreePart* a, const TreePart* b) { return a->cell < b->cell; });
  return parts;
}

/** Fills packets, one behind the other. */
class Packer {
 public:
  Packer(const TreeParts& parts, const PartCoder& coder, std::size_t maxBytes)
      : m_parts(parts.parts), m_all(parts), m_coder(coder), m_maxBytes(maxBytes) {}

  std::vector<PacketContent> packets() {
    std::vector<PacketContent> packets;
    for (Iterator at = m_parts.begin(); at != m_parts.end();) {
      Iterator end = at + static_cast<std::ptrdiff_t>(numThatFit(at));
      for (Iterator cut = end; cut != at; --cut)
        if (cut == m_parts.end() || cut->begins) {
          end = cut;
          break;
        }
      packets.push_back({m_coder.encode(sorted(at, end)), prefixBefore(end)});
      at = end;
    }
    return packets;
  }

 private:
  std::size_t sizeOf(Iterator at, std::size_t number) const {
    return m_coder.encode(sorted(at, at + static_cast<std::ptrdiff_t>(number))).size();
  }
  /** Up to a 64th; one always does. */
  std::size_t numThatFit(Iterator at) {
    const std::size_t most =
        std::min<std::size_t>(static_cast<std::size_t>(m_parts.end() - at), UINT16_MAX);
    std::size_t fits = 1, exceeds = most + 1;
    for (std::size_t n = m_last; exceeds - fits > 1 + fits / 64;) {
      n = std::clamp(n, fits + 1, exceeds - 1);
      const std::size_t size = sizeOf(at, n);
      (size <= m_maxBytes ? fits : exceeds) = n;
      n = n * m_maxBytes / std::max<std::size_t>(size, 1);
    }
    return m_last = fits;
  }
  StreamPrefix prefixBefore(Iterator end) const {
    StreamPrefix prefix;
    const std::size_t step = (end - 1)->step;
    prefix.isWhole = end == m_parts.end() || end->step != step;
    const bool isOptimal = end == m_parts.end() || (end->begins && (step > 0 || prefix.isWhole));
    if (!isOptimal) return prefix;
    if (end == m_parts.end())
      prefix.alpha = m_all.alphas.back();
    else
      prefix.alpha = prefix.isWhole ? m_all.alphas[step] : m_all.ties[step];
    return prefix;
  }

  const std::vector<OrderedPart>& m_parts;
  const TreeParts& m_all;
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

std::string StreamDescription::compressed() const {
  std::string text;
  Fields fields(text);
  fields.put(checksum);
  fields.put(static_cast<std::uint8_t>(rootDepth));
  fields.putText(coding);
  fields.putText(kind);
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
  return d;
}

std::string fileOf(const SemanticOcTree& map) {
  std::ostringstream out;
  writeTree(out, map);
  return out.str();
}

std::uint32_t checksumOf(const SemanticOcTree& map) {
  const std::string file = fileOf(map);
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const unsigned char*>(file.data()), file.size()));
}

std::vector<PacketContent> packetsOf(const TreeParts& parts, const PartCoder& coder,
                                     std::size_t maxBytes) {
  return Packer(parts, coder, maxBytes).packets();
}

PartCoder coderFor(const TreeParts& parts, int numClasses, int rootDepth) {
  constexpr std::ptrdiff_t kPerGroup = 128;  // about a packet's
  std::vector<std::vector<const TreePart*>> groups;
  const auto end = parts.parts.end();
  for (auto at = parts.parts.begin(); at != end; at += std::min(kPerGroup, end - at))
    groups.push_back(sorted(at, at + std::min(kPerGroup, end - at)));
  PartCoder coder(numClasses, rootDepth);
  coder.learn(groups);
  return coder;
}

}  // namespace semantic_octree
