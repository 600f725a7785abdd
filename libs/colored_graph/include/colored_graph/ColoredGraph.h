#pragma once
#include <colored_graph/ChangeLog.h>
#include <colored_graph/Edge.h>

#include <cstddef>
#include <vector>

namespace colored_graph {

/** One end of an edge, as seen from a vertex. */
struct Incidence {
  VertexId neighbor;
  EdgeId edge;
};
using Incidences = std::vector<Incidence>;

/** A graph whose vertices have a class and whose edges have a profile of classes. Edges lead both
 * ways unless their tolls close one.
 *
 * Vertices and edges are inserted in O(1) amortized; what is asked of an edge or done to it takes
 * O(degree of its ends). An id stays valid until its vertex or edge is removed; then it may be
 * given out again. Parallel edges are allowed, loops are not. Every
 * method that takes an id throws std::out_of_range for one that is not in the graph, and leaves the
 * graph as it was whenever it throws. */
class ColoredGraph {
 public:
  /** \throw std::invalid_argument classes < 1. */
  explicit ColoredGraph(int classes);

  /** \throw std::invalid_argument class not below classes(). */
  VertexId addVertex(GraphClass id);
  /** Removes the vertex and its edges. */
  void removeVertex(VertexId v);
  /** \throw std::invalid_argument class not below classes(). */
  void setVertexClass(VertexId v, GraphClass id);

  /** A usable edge.
   * \throw std::invalid_argument loop, profile empty, negative length, class not below classes(),
   * a total length above 2^62, or a toll that is neither kClosed nor in [0, 2^62). */
  EdgeId addEdge(VertexId a, VertexId b, EdgeProfile profile, Tolls tolls = {});
  /** An edge that a search evaluates when it needs to.
   * \param minLength lower bound of its length.
   * \throw std::invalid_argument loop, negative length, or tolls as in addEdge(). */
  EdgeId addUnevaluatedEdge(VertexId a, VertexId b, Length minLength, Tolls tolls = {});
  void removeEdge(EdgeId e);

  /** Makes the edge usable, with this profile.
   * \throw std::invalid_argument as addEdge(), and if an unevaluated edge turns out to be shorter
   * than its lower bound: searches relied on that. */
  void setProfile(EdgeId e, EdgeProfile profile);
  void setBlocked(EdgeId e);

  int classes() const { return m_classes; }
  std::size_t vertexCount() const { return m_vertexCount; }
  std::size_t edgeCount() const { return m_edgeCount; }
  /** One above the largest id ever given out. */
  VertexId vertexIdEnd() const { return static_cast<VertexId>(m_vertices.size()); }
  EdgeId edgeIdEnd() const { return static_cast<EdgeId>(m_edges.size()); }
  bool containsVertex(VertexId v) const { return v < m_vertices.size() && m_vertices[v].present; }
  bool containsEdge(EdgeId e) const { return e < m_edges.size() && m_edges[e].a != kNoVertex; }

  GraphClass vertexClass(VertexId v) const { return m_vertices[checked(v)].classId; }
  /** The edges at v, whichever way they lead, in no particular order; valid until the graph
   * changes. */
  const Incidences& incident(VertexId v) const { return m_vertices[checked(v)].incident; }
  /** Valid until the graph changes. */
  const Edge& edge(EdgeId e) const { return m_edges[checkedEdge(e)]; }

  /** For searches that follow the changes. */
  const ChangeLog& changes() const { return m_changes; }

 private:
  struct Vertex {
    bool present = false;
    GraphClass classId = 0;
    Incidences incident;
  };

  VertexId checked(VertexId v) const {
    if (!containsVertex(v)) refuseVertex(v);
    return v;
  }
  EdgeId checkedEdge(EdgeId e) const {
    if (!containsEdge(e)) refuseEdge(e);
    return e;
  }
  [[noreturn]] static void refuseVertex(VertexId v);
  [[noreturn]] static void refuseEdge(EdgeId e);
  void checkClass(GraphClass id) const;
  Length checkedLength(const EdgeProfile& profile) const;
  EdgeId insert(Edge edge);
  void setContent(EdgeId e, EdgeState state, Length length, EdgeProfile profile);
  void logVertex(VertexId v);

  int m_classes;
  std::vector<Vertex> m_vertices;
  std::vector<Edge> m_edges;  // without ends: not in the graph
  std::vector<VertexId> m_freeVertices;
  std::vector<EdgeId> m_freeEdges;
  std::size_t m_vertexCount = 0, m_edgeCount = 0;
  ChangeLog m_changes;
};

}  // namespace colored_graph
