#pragma once
#include <colored_graph/Edge.h>

#include <array>
#include <cstddef>
#include <cstdint>
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

/** The rows of edges of all vertices, each in one piece. A row that needs more room moves; the
 * place that it leaves serves other rows. */
class EdgeRows {
 public:
  struct Row {
    std::uint32_t first = 0, size = 0;
    std::uint8_t room = 0;  // a number of a size, see capacity()
  };

  [[gnu::always_inline]] EdgeRow row(const Row& row) const {
    if (row.size == 0) return {nullptr, nullptr, 0};
    const Page& page = m_pages[row.first / kPage];
    return {&page.halves[row.first % kPage], &page.edges[row.first % kPage], row.size};
  }
  HalfEdge& half(const Row& row, std::uint32_t place) {
    return m_pages[row.first / kPage].halves[row.first % kPage + place];
  }
  /** Where an edge of the row stands in it. */
  std::uint32_t find(const Row& row, EdgeId e) const;
  void push(Row& row, const HalfEdge& half, EdgeId e);
  /** The last edge of the row takes the place. */
  void remove(Row& row, std::uint32_t place);
  /** Gives up the room of a row without edges. */
  void release(Row& row);

 private:
  static constexpr std::uint32_t kPage = 2048;
  static constexpr std::uint8_t kRooms = 64;

  struct Page {
    std::vector<HalfEdge> halves;
    std::vector<EdgeId> edges;
  };

  static std::uint32_t capacity(std::uint8_t room);
  std::uint32_t take(std::uint8_t room);

  std::vector<Page> m_pages;  // a row that is longer than a page has a longer one to itself
  std::uint32_t m_left = 0;   // in the last page
  std::array<std::vector<std::uint32_t>, kRooms> m_free;
};

}  // namespace colored_graph
