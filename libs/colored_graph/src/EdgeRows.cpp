#include <colored_graph/EdgeRows.h>

#include <algorithm>

namespace colored_graph {

/** 0, 1, 2, 3, 4, 6, 8, 12, 16, ... */
std::uint32_t EdgeRows::capacity(std::uint8_t room) {
  if (room < 2) return room;
  return room % 2 ? 3u << (room - 3) / 2 : 2u << (room - 2) / 2;
}

std::uint32_t EdgeRows::find(const Row& row, EdgeId e) const {
  const EdgeRow view = this->row(row);
  return static_cast<std::uint32_t>(std::find(view.edges, view.edges + view.size, e) - view.edges);
}

void EdgeRows::push(Row& row, const HalfEdge& half, EdgeId e) {
  if (row.size == capacity(row.room)) {
    Row larger{0, row.size, static_cast<std::uint8_t>(row.room + 1)};
    larger.first = take(larger.room);
    const EdgeRow old = this->row(row);
    Page& page = m_pages[larger.first / kPage];
    std::copy_n(old.halves, old.size, page.halves.begin() + larger.first % kPage);
    std::copy_n(old.edges, old.size, page.edges.begin() + larger.first % kPage);
    row.size = 0;
    release(row);
    row = larger;
  }
  Page& page = m_pages[row.first / kPage];
  page.halves[row.first % kPage + row.size] = half;
  page.edges[row.first % kPage + row.size] = e;
  ++row.size;
}

void EdgeRows::remove(Row& row, std::uint32_t place) {
  Page& page = m_pages[row.first / kPage];
  const std::uint32_t at = row.first % kPage + place, last = row.first % kPage + row.size - 1;
  page.halves[at] = page.halves[last];
  page.edges[at] = page.edges[last];
  --row.size;
}

void EdgeRows::release(Row& row) {
  if (row.room > 0) m_free[row.room].push_back(row.first);
  row = Row();
}

std::uint32_t EdgeRows::take(std::uint8_t room) {
  if (!m_free[room].empty()) {
    const std::uint32_t first = m_free[room].back();
    m_free[room].pop_back();
    return first;
  }
  const std::uint32_t needed = capacity(room);
  if (needed > m_left) {
    const std::uint32_t size = std::max(needed, kPage);
    m_pages.push_back({std::vector<HalfEdge>(size), std::vector<EdgeId>(size)});
    m_left = size;
  }
  const std::uint32_t used = static_cast<std::uint32_t>(m_pages.back().edges.size()) - m_left;
  m_left -= needed;
  return static_cast<std::uint32_t>(m_pages.size() - 1) * kPage + used;
}

}  // namespace colored_graph
