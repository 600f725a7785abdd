#include "PartCoder.h"

#include <zdict.h>
#include <zstd.h>

#include <algorithm>
#include <map>
#include <new>
#include <stdexcept>

#include "Bytes.h"

namespace semantic_octree {
namespace {

constexpr int kLevel = 9;
constexpr std::size_t kMostFrequent = 255, kWrittenOut = 255;
constexpr std::size_t kMostDictionary = 1 << 12, kMostSamples = 256, kMostPlain = 1 << 22;

[[noreturn]] void fail() { throw std::runtime_error("altered: a part of a tree that cannot be"); }

std::size_t fine(std::size_t size) {
  if (ZSTD_isError(size)) throw std::runtime_error("altered: it cannot be unpacked");
  return size;
}

/** What Zstandard made, unless there is no memory. */
template <class T>
T* made(T* thing) {
  if (!thing) throw std::bad_alloc();
  return thing;
}

}  // namespace

std::string packed(const std::string& bytes, const ZSTD_CDict_s* dictionary) {
  thread_local const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(
      made(ZSTD_createCCtx()), ZSTD_freeCCtx);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kLevel);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_dictIDFlag, 0);
  ZSTD_CCtx_refCDict(context.get(), dictionary);
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  packed.resize(
      fine(ZSTD_compress2(context.get(), &packed[0], packed.size(), bytes.data(), bytes.size())));
  return packed;
}

std::string unpacked(const std::string& packed, std::size_t most, const ZSTD_DDict_s* dictionary) {
  thread_local const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(
      made(ZSTD_createDCtx()), ZSTD_freeDCtx);
  const auto size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size > most) fail();
  std::string bytes(size, '\0');
  if (fine(ZSTD_decompress_usingDDict(context.get(), &bytes[0], size, packed.data(), packed.size(),
                                      dictionary)) != size)
    fail();
  return bytes;
}

namespace {

/** Where parts are: by the distance of the root that each lies in from the one before. */
class Places {
 public:
  explicit Places(int rootDepth) : m_rootDepth(rootDepth) {}

  void write(const TreePart& part, ByteWriter& to) {
    const std::uint64_t root = part.cell.first() >> 3 * (kTreeDepth - m_rootDepth);
    to.number(root - std::exchange(m_root, root));
    const int below = part.cell.depth - m_rootDepth;
    to.value(static_cast<std::uint8_t>(part.isOctet ? kOctet + below : -below));
    if (!part.isOctet) return;
    to.number(part.cell.path & ((std::uint64_t(1) << 3 * below) - 1));
    to.value(part.mask);
  }

  void read(ByteReader& from, TreePart& part) {
    m_root += from.number();
    if (m_root >> 3 * m_rootDepth) fail();
    const int kind = from.take<std::uint8_t>();
    part.isOctet = kind >= kOctet;
    const int below = part.isOctet ? kind - kOctet : -kind;
    if (-below > m_rootDepth) fail();
    part.cell = CellPath{m_root, m_rootDepth}.above(m_rootDepth + std::min(below, 0));
    if (!part.isOctet) return;
    if (below >= kTreeDepth - m_rootDepth) fail();
    const std::uint64_t path = from.number();
    from.value(part.mask);
    if (path >> 3 * below || part.mask == 0) fail();
    part.cell = {m_root << 3 * below | path, m_rootDepth + below};
  }

 private:
  static constexpr int kOctet = 1 << 7;
  int m_rootDepth;
  std::uint64_t m_root = 0;
};

std::string bytesOf(const StreamLeaf& leaf) {
  ByteWriter writer;
  put(writer, leaf);
  return writer.bytes;
}

void check(const StreamLeaf& leaf, int numClasses) {
  if (leaf && leaf->value == kUnknown) fail();
  if (!leaf || !leaf->record) return;
  const ClassRecord& record = *leaf->record;
  if (record.rest == kUnknown || record.count > std::min(3, numClasses)) fail();
  for (int i = 0; i < record.count; ++i) {
    const bool isTwice = std::find(record.ids, record.ids + i, record.ids[i]) != record.ids + i;
    if (record.ids[i] < 1 || record.ids[i] > numClasses || isTwice || record.logOdds[i] == kUnknown)
      fail();
  }
  Belief sorted = record.belief();
  sorted.sort();
  if (ClassRecord::of(sorted) != record) fail();
}

}  // namespace

PartCoder::PartCoder(int numClasses, int rootDepth)
    : m_numClasses(numClasses), m_rootDepth(rootDepth) {}

void PartCoder::learn(const std::function<void(const VisitGroup&)>& forEachGroup) {
  std::map<std::string, std::size_t> counts;
  std::size_t groups = 0;
  forEachGroup([&](const auto& group) {
    ++groups;
    for (const TreePart* part : group)
      forEachLeaf(*part, [&](const StreamLeaf& leaf) { ++counts[bytesOf(leaf)]; });
  });
  std::vector<std::pair<std::size_t, std::string>> sorted;
  for (const auto& [leaf, count] : counts)
    if (count > leaf.size())
      sorted.emplace_back(count, leaf);  // its entry saves more than it costs
  std::sort(sorted.rbegin(), sorted.rend());
  if (sorted.size() > kMostFrequent) sorted.resize(kMostFrequent);
  m_frequent.clear();
  for (const auto& each : sorted) m_frequent.push_back(each.second);
  std::sort(m_frequent.begin(), m_frequent.end());
  const std::size_t every = 1 + groups / kMostSamples;
  std::string samples;
  std::vector<std::size_t> sizes;
  forEachGroup([&](const auto& group) {
    if (groups++ % every != 0) return;
    const std::string bytes = plain(group);
    samples += bytes;
    sizes.push_back(bytes.size());
  });
  m_dictionary.assign(kMostDictionary, '\0');
  const std::size_t size =
      ZDICT_trainFromBuffer(&m_dictionary[0], m_dictionary.size(), samples.data(), sizes.data(),
                            static_cast<unsigned>(sizes.size()));
  m_dictionary.resize(ZDICT_isError(size) ? 0 : size);
  m_packing = {made(ZSTD_createCDict(m_dictionary.data(), m_dictionary.size(), kLevel)),
               ZSTD_freeCDict};
}

std::string PartCoder::plain(const std::vector<const TreePart*>& parts) const {
  ByteWriter places, leaves, others;
  places.value(static_cast<std::uint16_t>(parts.size()));
  Places written(m_rootDepth);
  for (const TreePart* part : parts) {
    written.write(*part, places);
    forEachLeaf(*part, [&](const StreamLeaf& leaf) {
      const std::string bytes = bytesOf(leaf);
      const auto found = std::lower_bound(m_frequent.begin(), m_frequent.end(), bytes);
      const bool isFrequent = found != m_frequent.end() && *found == bytes;
      leaves.value(
          static_cast<std::uint8_t>(isFrequent ? found - m_frequent.begin() : int(kWrittenOut)));
      if (!isFrequent) others.bytes += bytes;
    });
  }
  return places.bytes + leaves.bytes + others.bytes;
}

std::string PartCoder::encode(const std::vector<const TreePart*>& parts) const {
  return packed(plain(parts), m_packing.get());
}

std::vector<TreePart> PartCoder::decode(const std::string& packed) const {
  const std::string bytes = unpacked(packed, kMostPlain, m_unpacking.get());
  ByteReader reader(bytes);
  std::vector<TreePart> parts(reader.take<std::uint16_t>());
  Places read(m_rootDepth);
  for (TreePart& part : parts) read.read(reader, part);
  std::vector<StreamLeaf*> others;
  for (TreePart& part : parts)
    forEachLeaf(part, [&](StreamLeaf& leaf) {
      const auto number = reader.take<std::uint8_t>();
      if (number == kWrittenOut) return others.push_back(&leaf);
      if (number >= m_frequent.size()) fail();
      ByteReader frequent(m_frequent[number]);
      get(frequent, leaf);
    });
  for (StreamLeaf* leaf : others) {
    get(reader, *leaf);
    check(*leaf, m_numClasses);
  }
  return parts;
}

std::string PartCoder::toText() const {
  ByteWriter writer;
  writer.value(static_cast<std::uint8_t>(m_frequent.size()));
  for (const std::string& leaf : m_frequent) writer.bytes += leaf;
  return writer.bytes + m_dictionary;
}

void PartCoder::fromText(const std::string& text) {
  ByteReader reader(text);
  m_frequent.resize(reader.take<std::uint8_t>());
  for (std::string& bytes : m_frequent) {
    StreamLeaf leaf;
    get(reader, leaf);
    check(leaf, m_numClasses);
    bytes = bytesOf(leaf);
  }
  m_dictionary = reader.rest();
  m_unpacking = {ZSTD_createDDict(m_dictionary.data(), m_dictionary.size()), ZSTD_freeDDict};
  if (!m_unpacking) fail();
}

}  // namespace semantic_octree
