#include "PartCoder.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "Bytes.h"

namespace semantic_octree {

/** How parts become bits, in both directions: see RangeCoder.h.
 *
 * A part begins with the distance of its root (the cube of the trees' roots that it lies in) from
 * that of the part before, and whether it is an octet. An octet has its depth below the root, its
 * path from there, and the mask of children; a leaf its depth. Then each leaf: none, plain or with
 * a record. A plain one has its log-odds. A record is that of the leaf before, one of the frequent
 * ones, or written out. Then come the number of named classes, which ones, the log-odds of the
 * rest, and what the named ones have more. At the end come the leaf's log-odds, if they do not
 * follow from that. */
template <typename Coder>
class PartFormat {
 public:
  enum Context : std::size_t {
    kGap = 0,
    kIsOctet = kGap + 64,
    kLeafDepth = kIsOctet + 2,
    kOctetDepth = kLeafDepth + 32,
    kMask = kOctetDepth + 16,
    kIsNone = kMask + 2 * 256,
    kHasRecord = kIsNone + 6,
    kPlain = kHasRecord + 6,
    kSameRecord = kPlain + 4 * 256,
    kIsFrequent = kSameRecord + 2,
    kFrequent = kIsFrequent + 1,
    kCount = kFrequent + 256,
    kSameClasses = kCount + 4,
    kClass = kSameClasses + 1,
    kRest = kClass + 2 * 256,
    kDifference = kRest + 256,
    kFollows = kDifference + 2 * 256,
    kNumContexts = kFollows + 1
  };

  PartFormat(const PartCoder& tables, Coder& coder) : m_tables(tables), m_coder(coder) {}

  void code(TreePart& part) {
    codeRoot(part);
    bit(kIsOctet + m_wasOctet, part.isOctet);
    part.isOctet ? codeOctetPlace(part) : codeLeafPlace(part);
    m_wasOctet = part.isOctet;
    m_kindBefore = 0;
    for (int i = 0; i < 8; ++i)
      if (part.mask >> i & 1) code(part.leaves[i]);
  }

 private:
  [[noreturn]] static void fail() {
    throw std::runtime_error("altered: a part of a tree that cannot be");
  }
  void bit(std::size_t context, bool& b) { m_coder.bit(context, b); }
  /** The highest bit first, each with a context for what was before it. */
  template <typename T>
  void tree(std::size_t context, T& value, int bits) {
    unsigned seen = 1;
    for (int i = bits - 1; i >= 0; --i) {
      bool b = static_cast<unsigned>(value) >> i & 1;
      bit(context + seen, b);
      seen = seen << 1 | b;
    }
    value = static_cast<T>(seen - (1u << bits));
  }

  void codeRoot(TreePart& part) {
    const int rootDepth = m_tables.m_rootDepth;
    const std::uint64_t root = part.cell.first() >> 3 * (kTreeDepth - rootDepth);
    const std::uint64_t gap = root > m_root ? root - m_root : 0;  // a decoder is told
    unsigned bits = 0;
    while (gap >> bits) ++bits;
    tree(kGap, bits, 6);
    std::uint64_t tail = bits > 1 ? gap ^ std::uint64_t(1) << (bits - 1) : 0;
    if (bits > 48) fail();
    if (bits > 1) m_coder.direct(tail, static_cast<int>(bits) - 1);
    m_root += bits == 0 ? 0 : std::uint64_t(1) << (bits - 1) | tail;
    if (m_root >> 3 * rootDepth) fail();
  }

  void codeOctetPlace(TreePart& part) {
    const int rootDepth = m_tables.m_rootDepth;
    int below = part.cell.depth - rootDepth;
    tree(kOctetDepth, below, 4);
    if (below >= kTreeDepth - rootDepth) fail();
    std::uint64_t path = part.cell.path & ((std::uint64_t(1) << 3 * below) - 1);
    m_coder.direct(path, 3 * below);
    part.cell = {m_root << 3 * below | path, rootDepth + below};
    tree(kMask + 256 * (below > 0), part.mask, 8);
    if (part.mask == 0) fail();
  }

  void codeLeafPlace(TreePart& part) {
    const int rootDepth = m_tables.m_rootDepth;
    int above = rootDepth - part.cell.depth;
    tree(kLeafDepth, above, 5);
    if (above > rootDepth) fail();
    part.cell = {m_root >> 3 * above, rootDepth - above};
    part.mask = 1;
  }

  void code(StreamLeaf& leaf) {
    const std::size_t context = m_kindBefore + 3 * m_wasOctet;
    bool isNone = !leaf, hasRecord = leaf && leaf->record;
    bit(kIsNone + context, isNone);
    if (!isNone) bit(kHasRecord + context, hasRecord);
    m_kindBefore = isNone ? 0 : 1 + hasRecord;
    if (isNone) return leaf.reset();
    if (!leaf) leaf.emplace();
    if (hasRecord && !leaf->record) leaf->record.emplace();
    if (hasRecord) return codeWithRecord(*leaf);
    leaf->record.reset();
    m_plainBefore =
        std::min<std::size_t>(3, code(kPlain + 256 * m_plainBefore, m_tables.m_plain, leaf->value));
  }

  void codeWithRecord(LeafContent& leaf) {
    bool isSame = leaf == m_before;
    bit(kSameRecord + m_wasSame, isSame);
    m_wasSame = isSame;
    if (isSame && !m_before.record) fail();
    if (isSame) {
      leaf = m_before;
      return;
    }
    const auto& records = m_tables.m_records;
    auto number =
        static_cast<std::size_t>(std::find(records.begin(), records.end(), leaf) - records.begin());
    bool isFrequent = number < records.size();
    bit(kIsFrequent, isFrequent);
    if (isFrequent) {
      tree(kFrequent, number, 8);
      if (number >= records.size()) fail();
      leaf = records[number];
    } else {
      codeRecord(*leaf.record);
      codeValue(leaf);
    }
    m_before = leaf;
  }

  void codeRecord(ClassRecord& record) {
    tree(kCount, record.count, 2);
    if (record.count > std::min(3, m_tables.m_numClasses)) fail();
    codeClasses(record);
    code(kRest, m_tables.m_rests, record.rest);
    for (int i = 0; i < record.count; ++i) {
      auto difference = static_cast<Units>(record.logOdds[i] - record.rest);
      code(kDifference + 256 * (i > 0), m_tables.m_differences, difference);
      record.logOdds[i] = static_cast<Units>(record.rest + difference);
      if (record.logOdds[i] == kUnknown) fail();
    }
    if (record.rest == kUnknown || ClassRecord::of(sorted(record.belief())) != record) fail();
  }

  void codeClasses(ClassRecord& record) {
    const ClassRecord before = m_before.record.value_or(ClassRecord{});
    bool same = before.count == record.count && std::equal(record.ids, record.ids + 3, before.ids);
    bit(kSameClasses, same);
    if (same && before.count != record.count) fail();
    for (int i = 0; i < record.count; ++i) {
      same ? void(record.ids[i] = before.ids[i]) : tree(kClass + 256 * (i > 0), record.ids[i], 8);
      const bool isTwice = std::find(record.ids, record.ids + i, record.ids[i]) != record.ids + i;
      if (record.ids[i] < 1 || record.ids[i] > m_tables.m_numClasses || isTwice) fail();
    }
  }

  void codeValue(LeafContent& leaf) {
    const Units expected =
        toUnits(onGrid(leaf.record->belief().occupancyLogOdds(m_tables.m_numClasses)));
    bool follows = leaf.value == expected;
    bit(kFollows, follows);
    follows ? void(leaf.value = expected) : codeUnits(leaf.value);
    if (leaf.value == kUnknown) fail();
  }

  /** \return its place in the table */
  std::size_t code(std::size_t context, const std::vector<Units>& table, Units& value) {
    auto number =
        static_cast<std::size_t>(std::find(table.begin(), table.end(), value) - table.begin());
    if (number == table.size()) number = 255;
    tree(context, number, 8);
    if (number < 255 && number >= table.size()) fail();
    number < 255 ? void(value = table[number]) : codeUnits(value);
    if (value == kUnknown) fail();
    return number;
  }
  void codeUnits(Units& value) {
    std::uint64_t bits = static_cast<std::uint16_t>(value);
    m_coder.direct(bits, 16);
    value = static_cast<Units>(bits);
  }
  static Belief sorted(Belief belief) {
    belief.sort();
    return belief;
  }

  const PartCoder& m_tables;
  Coder& m_coder;
  std::uint64_t m_root = 0;
  bool m_wasOctet = false, m_wasSame = false;
  std::size_t m_kindBefore = 0, m_plainBefore = 0;
  LeafContent m_before;  ///< the last one with a record
};

constexpr std::size_t kMaxFrequent = 255;
constexpr std::size_t kNumContexts = PartFormat<BitCounter>::kNumContexts;

namespace {

struct ByBytes {
  bool operator()(const LeafContent& a, const LeafContent& b) const {
    const int order = std::memcmp(&*a.record, &*b.record, sizeof(ClassRecord));
    return order != 0 ? order < 0 : a.value < b.value;
  }
};

/** The most frequent values, if they are there at least so often. */
template <typename T, typename Less>
std::vector<T> mostFrequent(const std::map<T, std::size_t, Less>& counts, std::size_t atLeast) {
  std::vector<std::pair<std::size_t, const T*>> sorted;
  for (const auto& [value, count] : counts)
    if (count >= atLeast) sorted.emplace_back(count, &value);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  if (sorted.size() > kMaxFrequent) sorted.resize(kMaxFrequent);
  std::vector<T> values;
  for (const auto& [count, value] : sorted) values.push_back(*value);
  return values;
}

/** How often what is said. */
struct LeafCounts {
  std::map<Units, std::size_t, std::less<Units>> plain, rests, differences;
  std::map<LeafContent, std::size_t, ByBytes> records;

  void add(const TreePart& part) {
    for (int i = 0; i < 8; ++i)
      if (part.mask >> i & 1 && part.leaves[i]) add(*part.leaves[i]);
  }
  void add(const LeafContent& leaf) {
    if (!leaf.record) return void(++plain[leaf.value]);
    ++records[leaf];
    ++rests[leaf.record->rest];
    for (int c = 0; c < leaf.record->count; ++c)
      ++differences[static_cast<Units>(leaf.record->logOdds[c] - leaf.record->rest)];
  }
};

}  // namespace

PartCoder::PartCoder(int numClasses, int rootDepth)
    : m_numClasses(numClasses),
      m_rootDepth(rootDepth),
      m_models(kNumContexts, 1 << (kModelBits - 1)) {}

void PartCoder::learn(const std::function<void(const VisitGroup&)>& forEachGroup) {
  LeafCounts counts;
  forEachGroup([&](const auto& group) {
    for (const TreePart* part : group) counts.add(*part);
  });
  // A table's entry must save more than it costs: 2 bytes, or 14 that compress to half.
  m_plain = mostFrequent(counts.plain, 3);
  m_rests = mostFrequent(counts.rests, 4);
  m_differences = mostFrequent(counts.differences, 4);
  m_records = mostFrequent(counts.records, 8);
  counts = {};
  BitCounter counter(kNumContexts);
  forEachGroup([&](const auto& group) {
    PartFormat<BitCounter> format(*this, counter);
    for (const TreePart* part : group) {
      TreePart copy = *part;
      format.code(copy);
    }
  });
  const std::string probabilities = counter.probabilities();
  for (std::size_t i = 0; i < kNumContexts; ++i)
    m_models[i] = static_cast<std::uint16_t>(static_cast<std::uint8_t>(probabilities[i]) << 3);
}

std::string PartCoder::encode(const std::vector<const TreePart*>& parts) const {
  RangeEncoder encoder(m_models);
  PartFormat<RangeEncoder> format(*this, encoder);
  for (const TreePart* part : parts) {
    TreePart copy = *part;
    format.code(copy);
  }
  ByteWriter writer;
  writer.value(static_cast<std::uint16_t>(parts.size()));
  return writer.bytes + encoder.finish();
}

std::vector<TreePart> PartCoder::decode(const std::string& bytes) const {
  ByteReader reader(bytes);
  std::vector<TreePart> parts(reader.take<std::uint16_t>());
  const std::string coded = reader.rest();
  RangeDecoder decoder(m_models, coded);
  PartFormat<RangeDecoder> format(*this, decoder);
  for (TreePart& part : parts) format.code(part);
  return parts;
}

std::string PartCoder::toText() const {
  ByteWriter writer;
  writer.list(m_plain);
  writer.list(m_rests);
  writer.list(m_differences);
  writer.value(static_cast<std::uint8_t>(m_records.size()));
  for (const LeafContent& leaf : m_records) {
    writer.value(*leaf.record);
    writer.value(leaf.value);
  }
  for (const std::uint16_t model : m_models) writer.value(static_cast<std::uint8_t>(model >> 3));
  return writer.bytes;
}

/** Codes each value as if it were told anew; a value that cannot be is refused. */
void PartCoder::checkRecords() const {
  const PartCoder plain(m_numClasses, m_rootDepth);
  for (const LeafContent& leaf : m_records) {
    BitCounter unused(kNumContexts);
    PartFormat<BitCounter> format(plain, unused);
    TreePart part;
    part.leaves[0] = leaf;
    format.code(part);
    if (!(part.leaves[0] == leaf))
      throw std::runtime_error("altered: a class record that cannot be");
  }
}

void PartCoder::fromText(const std::string& text) {
  ByteReader reader(text);
  reader.list(m_plain);
  reader.list(m_rests);
  reader.list(m_differences);
  m_records.assign(reader.take<std::uint8_t>(), LeafContent());
  for (LeafContent& leaf : m_records) {
    reader.value(leaf.record.emplace());
    reader.value(leaf.value);
  }
  checkRecords();
  for (std::uint16_t& model : m_models) {
    const auto p = reader.take<std::uint8_t>();
    if (p == 0) throw std::runtime_error("altered: a probability of 0");
    model = static_cast<std::uint16_t>(p << 3);
  }
}

}  // namespace semantic_octree
