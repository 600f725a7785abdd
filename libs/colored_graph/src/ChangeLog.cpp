#include <colored_graph/ChangeLog.h>

namespace colored_graph {

void ChangeLog::push(VertexId vertex, std::size_t keep) {
  if (m_vertices.size() >= 2 * keep) {
    const std::size_t drop = m_vertices.size() - keep;
    m_vertices.erase(m_vertices.begin(), m_vertices.begin() + static_cast<std::ptrdiff_t>(drop));
    m_dropped += drop;
  }
  m_vertices.push_back(vertex);
}

}  // namespace colored_graph
