#pragma once
#include <cstddef>
#include <vector>

namespace colored_graph {

/** An array in pages: it grows without moving what it holds, and has no more room than a page
 * beyond that. */
template <class T>
class PagedArray {
 public:
  std::size_t size() const { return m_size; }
  T& operator[](std::size_t i) { return m_pages[i / kPage][i % kPage]; }
  const T& operator[](std::size_t i) const { return m_pages[i / kPage][i % kPage]; }
  void emplace_back() {
    if (m_size == m_pages.size() * kPage) m_pages.emplace_back(kPage);
    ++m_size;
  }

 private:
  static constexpr std::size_t kPage = 1024;

  std::vector<std::vector<T>> m_pages;
  std::size_t m_size = 0;
};

}  // namespace colored_graph
