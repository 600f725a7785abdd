#pragma once
#include <colored_graph/Edge.h>

#include <cstddef>
#include <cstdint>
#include <deque>

namespace colored_graph {

/** The vertices at whose edges something changed, oldest first, each with a running number. The
 * oldest entries are dropped when the log has grown long: a reader that has fallen behind begin()
 * has to look at everything again. */
class ChangeLog {
 public:
  /** \param keep as many of the latest entries stay at least. */
  void push(VertexId vertex, std::size_t keep);

  std::uint64_t begin() const { return m_dropped; }
  std::uint64_t end() const { return m_dropped + m_vertices.size(); }
  VertexId operator[](std::uint64_t number) const { return m_vertices[number - m_dropped]; }

 private:
  std::uint64_t m_dropped = 0;
  std::deque<VertexId> m_vertices;
};

}  // namespace colored_graph
