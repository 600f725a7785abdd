#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace semantic_planning {

/** Hands out what has the least key, and of that the least value; no key may be less than the last
 * one that it handed out. Keys that differ from that in the same highest bit share a bucket, which
 * is dealt out when its turn comes (the radix heap of Ahuja et al., "Faster algorithms for the
 * shortest path problem", 1990): that touches less memory than a binary heap. */
template <class Value>
class MonotoneQueue {
 public:
  using Key = std::int64_t;
  using Entry = std::pair<Key, Value>;

  bool empty() const { return m_size == 0; }
  void push(Key key, const Value& value) {
    m_buckets[bucketOf(key)].emplace_back(key, value);
    if (key == m_last) std::push_heap(m_buckets[0].begin(), m_buckets[0].end(), IsAfter());
    ++m_size;
  }
  const Entry& top() {
    deal();
    return m_buckets[0].front();
  }
  Entry pop() {
    deal();
    std::pop_heap(m_buckets[0].begin(), m_buckets[0].end(), IsAfter());
    const Entry entry = m_buckets[0].back();
    m_buckets[0].pop_back();
    --m_size;
    return entry;
  }

 private:
  struct IsAfter {
    bool operator()(const Entry& a, const Entry& b) const { return b.second < a.second; }
  };

  std::size_t bucketOf(Key key) const {
    const auto differs = static_cast<std::uint64_t>(key ^ m_last);
    return differs == 0 ? 0 : 64 - static_cast<std::size_t>(__builtin_clzll(differs));
  }

  /** Fills the first bucket, that of the least key. */
  void deal() {
    if (!m_buckets[0].empty()) return;
    const auto bucket = std::find_if(m_buckets.begin() + 1, m_buckets.end(),
                                     [](const auto& entries) { return !entries.empty(); });
    m_last = std::min_element(bucket->begin(), bucket->end(), [](const Entry& a, const Entry& b) {
               return a.first < b.first;
             })->first;
    for (const Entry& e : *bucket) m_buckets[bucketOf(e.first)].push_back(e);
    bucket->clear();
    std::make_heap(m_buckets[0].begin(), m_buckets[0].end(), IsAfter());
  }

  std::array<std::vector<Entry>, 65> m_buckets;  ///< by the highest bit that differs; 0: none
  std::size_t m_size = 0;
  Key m_last = 0;
};

}  // namespace semantic_planning
