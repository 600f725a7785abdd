#pragma once
#include <algorithm>
#include <stdexcept>

#include "PartCoder.h"

namespace semantic_octree {

/** How parts become bits, in both directions: see RangeCoder.h.
 *
 * A part: distance of its root (the cube of the trees' roots that it lies in) from that of the part
 * before; whether it is an octet; of an octet, its depth below the root, its path from there, and
 * the mask of children; of a leaf, its depth. Then each leaf: none, plain or with a record; of a
 * plain one its log-odds; of one with a record, whether it is that of the leaf before, one of the
 * frequent ones, or else: number of named classes, which ones, the log-odds of the rest, what those
 * of the named ones have more, and its log-odds if they do not follow from that. */
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
    bool isNone = leaf.kind == StreamLeaf::Kind::None,
         hasRecord = leaf.kind == StreamLeaf::Kind::WithRecord;
    bit(kIsNone + context, isNone);
    if (!isNone) bit(kHasRecord + context, hasRecord);
    leaf.kind = isNone      ? StreamLeaf::Kind::None
                : hasRecord ? StreamLeaf::Kind::WithRecord
                            : StreamLeaf::Kind::Plain;
    m_kindBefore = static_cast<std::size_t>(leaf.kind);
    if (leaf.kind == StreamLeaf::Kind::Plain)
      m_plainBefore = std::min<std::size_t>(
          3, code(kPlain + 256 * m_plainBefore, m_tables.m_plain, leaf.value));
    if (leaf.kind == StreamLeaf::Kind::WithRecord) codeWithRecord(leaf);
  }

  void codeWithRecord(StreamLeaf& leaf) {
    bool isSame = leaf == m_before;
    bit(kSameRecord + m_wasSame, isSame);
    m_wasSame = isSame;
    if (isSame && m_before.kind != StreamLeaf::Kind::WithRecord) fail();
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
      codeRecord(leaf.record);
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
    const ClassRecord& before = m_before.record;
    bool same = before.count == record.count && std::equal(record.ids, record.ids + 3, before.ids);
    bit(kSameClasses, same);
    if (same && before.count != record.count) fail();
    for (int i = 0; i < record.count; ++i) {
      same ? void(record.ids[i] = before.ids[i]) : tree(kClass + 256 * (i > 0), record.ids[i], 8);
      const bool isTwice = std::find(record.ids, record.ids + i, record.ids[i]) != record.ids + i;
      if (record.ids[i] < 1 || record.ids[i] > m_tables.m_numClasses || isTwice) fail();
    }
  }

  void codeValue(StreamLeaf& leaf) {
    const Units expected =
        toUnits(onGrid(leaf.record.belief().occupancyLogOdds(m_tables.m_numClasses)));
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
  StreamLeaf m_before;
};

}  // namespace semantic_octree
