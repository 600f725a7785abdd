#include "PartCoder.h"

#include <algorithm>
#include <map>

#include "PartFormat.h"

namespace semantic_octree {
namespace {

constexpr std::size_t kMaxFrequent = 255;
constexpr std::size_t kNumContexts = PartFormat<BitCounter>::kNumContexts;

struct ByBytes {
  bool operator()(const StreamLeaf& a, const StreamLeaf& b) const {
    const int order = std::memcmp(&a.record, &b.record, sizeof(a.record));
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
  std::map<StreamLeaf, std::size_t, ByBytes> records;

  void add(const TreePart& part) {
    for (int i = 0; i < 8; ++i)
      if (part.mask >> i & 1) add(part.leaves[i]);
  }
  void add(const StreamLeaf& leaf) {
    if (leaf.kind == StreamLeaf::Kind::Plain) ++plain[leaf.value];
    if (leaf.kind != StreamLeaf::Kind::WithRecord) return;
    ++records[leaf];
    ++rests[leaf.record.rest];
    for (int c = 0; c < leaf.record.count; ++c)
      ++differences[static_cast<Units>(leaf.record.logOdds[c] - leaf.record.rest)];
  }
};

template <typename T>
void put(std::string& text, const T& value) {
  text.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

template <typename T>
T get(const std::string& text, std::size_t& next) {
  if (text.size() - next < sizeof(T)) throw std::runtime_error("altered: a description too short");
  T value;
  std::memcpy(&value, text.data() + next, sizeof(T));
  next += sizeof(T);
  return value;
}

template <typename T>
void putAll(std::string& text, const std::vector<T>& values) {
  put(text, static_cast<std::uint8_t>(values.size()));
  for (const T& value : values) put(text, value);
}

template <typename T>
std::vector<T> getAll(const std::string& text, std::size_t& next) {
  std::vector<T> values(get<std::uint8_t>(text, next));
  for (T& value : values) value = get<T>(text, next);
  return values;
}

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
  std::string bytes;
  put(bytes, static_cast<std::uint16_t>(parts.size()));
  return bytes + encoder.finish();
}

std::vector<TreePart> PartCoder::decode(const std::string& bytes) const {
  std::size_t next = 0;
  std::vector<TreePart> parts(get<std::uint16_t>(bytes, next));
  const std::string coded = bytes.substr(next);
  RangeDecoder decoder(m_models, coded);
  PartFormat<RangeDecoder> format(*this, decoder);
  for (TreePart& part : parts) format.code(part);
  return parts;
}

std::string PartCoder::toText() const {
  std::string text;
  putAll(text, m_plain);
  putAll(text, m_rests);
  putAll(text, m_differences);
  put(text, static_cast<std::uint8_t>(m_records.size()));
  for (const StreamLeaf& leaf : m_records) {
    put(text, leaf.record);
    put(text, leaf.value);
  }
  for (const std::uint16_t model : m_models) put(text, static_cast<std::uint8_t>(model >> 3));
  return text;
}

/** As if each were told anew: what cannot be is refused. */
void PartCoder::checkRecords() const {
  const PartCoder plain(m_numClasses, m_rootDepth);
  for (const StreamLeaf& leaf : m_records) {
    BitCounter unused(kNumContexts);
    PartFormat<BitCounter> format(plain, unused);
    TreePart part;
    part.leaves[0] = leaf;
    format.code(part);
    if (part.leaves[0] != leaf) throw std::runtime_error("altered: a class record that cannot be");
  }
}

void PartCoder::fromText(const std::string& text, std::size_t& next) {
  m_plain = getAll<Units>(text, next);
  m_rests = getAll<Units>(text, next);
  m_differences = getAll<Units>(text, next);
  m_records.assign(get<std::uint8_t>(text, next), StreamLeaf());
  for (StreamLeaf& leaf : m_records) {
    leaf.kind = StreamLeaf::Kind::WithRecord;
    leaf.record = get<ClassRecord>(text, next);
    leaf.value = get<Units>(text, next);
  }
  checkRecords();
  for (std::uint16_t& model : m_models) {
    const auto p = get<std::uint8_t>(text, next);
    if (p == 0) throw std::runtime_error("altered: a probability of 0");
    model = static_cast<std::uint16_t>(p << 3);
  }
}

}  // namespace semantic_octree
