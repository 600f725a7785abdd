#pragma once
#include <colored_graph/Edge.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

namespace colored_graph {

/** What waits in a search: a vertex to expand, or (edge given) an unevaluated edge that may lead to
 * it. */
template <class Cost>
struct QueueEntry {
  Cost key;
  VertexId vertex;
  EdgeId edge;
  bool isVertex() const { return edge == kNoEdge; }
};

/** Entries by key, smallest first. Of equal keys, vertices go before edges, smaller ids first: a
 * way that is known is worth more than one that may tie it.
 *
 * A radix heap (Ahuja, Mehlhorn, Orlin, Tarjan 1990): no key is smaller than the last one taken
 * out, and an entry lies in the bucket of the highest bit in which its key differs from that. A key
 * that is smaller nevertheless counts as equal. */
template <class Cost>
class RadixQueue {
 public:
  using Entry = QueueEntry<Cost>;

  bool empty() const { return m_size == 0; }

  void push(const Entry& entry) {
    ++m_size;
    const int number = entry.key < m_last ? 0 : highestDifference(entry.key, m_last);
    put(number, entry);
    if (number == 0) std::push_heap(m_buckets[0].begin(), m_buckets[0].end(), comesLater);
  }

  Entry pop() {
    std::vector<Entry>& first = m_buckets[0];
    --m_size;
    if (first.empty()) {
      std::vector<Entry>& next = nextBucket();
      if (next.size() == 1) {  // half of all turns
        const Entry entry = next.front();
        next.clear();
        m_last = entry.key;
        return entry;
      }
      spread(next);
    }
    std::pop_heap(first.begin(), first.end(), comesLater);
    const Entry entry = first.back();
    first.pop_back();
    return entry;
  }

 private:
  static constexpr std::size_t kLarge = 256;  // a bucket of more entries gives its memory back

  static constexpr int kBuckets = Cost::kBits + 1;

  static bool comesLater(const Entry& l, const Entry& r) {
    return std::make_tuple(!l.isVertex(), l.vertex, l.edge) >
           std::make_tuple(!r.isVertex(), r.vertex, r.edge);
  }

  void put(int number, const Entry& entry) {
    m_buckets[number].push_back(entry);
    m_filled[number / 64] |= std::uint64_t{1} << number % 64;
  }

  /** The one with the smallest keys, no longer marked as filled. */
  std::vector<Entry>& nextBucket() {
    m_filled[0] &= ~std::uint64_t{1};
    int word = 0;
    while (m_filled[word] == 0) ++word;
    const int number = 64 * word + __builtin_ctzll(m_filled[word]);
    m_filled[word] &= m_filled[word] - 1;
    return m_buckets[number];
  }

  /** The smallest keys to bucket 0, and those that shared a bucket with them nearer to it. */
  void spread(std::vector<Entry>& bucket) {
    m_last = bucket.front().key;
    for (const Entry& entry : bucket)
      if (entry.key < m_last) m_last = entry.key;
    for (const Entry& entry : bucket) put(highestDifference(entry.key, m_last), entry);
    if (bucket.size() > kLarge)
      std::vector<Entry>().swap(bucket);
    else
      bucket.clear();
    std::make_heap(m_buckets[0].begin(), m_buckets[0].end(), comesLater);
  }

  Cost m_last{};
  std::size_t m_size = 0;
  std::array<std::vector<Entry>, kBuckets> m_buckets;
  std::array<std::uint64_t, kBuckets / 64 + 1> m_filled{};  // a bit for each bucket
};

}  // namespace colored_graph
