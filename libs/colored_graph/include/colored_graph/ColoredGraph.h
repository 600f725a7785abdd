#pragma once
#include <colored_graph/ClassOrder.h>
#include <colored_graph/Length.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace colored_graph {

using VertexId = std::uint32_t;
using EdgeId = std::uint32_t;
constexpr VertexId kNoVertex = ~VertexId{0};
constexpr EdgeId kNoEdge = ~EdgeId{0};

/** A part of an edge that lies in one class. Length 0 means: touched. */
struct Stretch {
  GraphClass classId;
  Length length;
};
using EdgeProfile = std::vector<Stretch>;

/** Unevaluated: only a lower bound of the length is known. Blocked: nobody can go there. */
enum class EdgeState : std::uint8_t { Unevaluated, Usable, Blocked };

struct Edge {
  VertexId a = kNoVertex, b = kNoVertex;
  Length length = 0;  ///< of the profile; while unevaluated a lower bound of it
  EdgeState state = EdgeState::Unevaluated;
  EdgeProfile profile;  ///< empty unless usable; a class may appear more than once

  VertexId other(VertexId v) const { return v == a ? b : a; }
};

/** One end of an edge, as seen from a vertex. */
struct Incidence {
  VertexId neighbor;
  EdgeId edge;
};

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
  std::vector<VertexId> m_vertices;
};

/** An undirected graph whose vertices have a class and whose edges have a profile of classes.
 *
 * Vertices and edges are inserted in O(1), edges removed in O(1), vertices in O(degree), all
 * amortized. An id stays valid until its vertex or edge is removed; then it may be given out again.
 * Parallel edges are allowed, loops are not. Every method that takes an id throws std::out_of_range
 * for one that is not in the graph, and leaves the graph as it was whenever it throws. */
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
   * or a total length above 2^62. */
  EdgeId addEdge(VertexId a, VertexId b, EdgeProfile profile);
  /** An edge that a search evaluates when it needs to.
   * \param minLength lower bound of its length.
   * \throw std::invalid_argument loop, or negative length. */
  EdgeId addUnevaluatedEdge(VertexId a, VertexId b, Length minLength);
  void removeEdge(EdgeId e);

  /** Makes the edge usable, with this profile.
   * \throw std::invalid_argument as addEdge(), and if an unevaluated edge turns out to be shorter
   * than its lower bound: searches relied on that. */
  void setProfile(EdgeId e, EdgeProfile profile);
  void setBlocked(EdgeId e);
  /** \throw std::invalid_argument negative length. */
  void setUnevaluated(EdgeId e, Length minLength);

  int classes() const { return m_classes; }
  std::size_t vertexCount() const { return m_vertexCount; }
  std::size_t edgeCount() const { return m_edgeCount; }
  /** One above the largest id ever given out. */
  VertexId vertexIdEnd() const { return static_cast<VertexId>(m_vertices.size()); }
  EdgeId edgeIdEnd() const { return static_cast<EdgeId>(m_edges.size()); }
  bool containsVertex(VertexId v) const { return v < m_vertices.size() && m_vertices[v].present; }
  bool containsEdge(EdgeId e) const { return e < m_edges.size() && m_edges[e].a != kNoVertex; }

  GraphClass vertexClass(VertexId v) const { return m_vertices[checked(v)].classId; }
  /** The edges at v, in no particular order; valid until the graph changes. */
  const std::vector<Incidence>& incident(VertexId v) const { return m_vertices[checked(v)].edges; }
  const Edge& edge(EdgeId e) const { return m_edges[checkedEdge(e)]; }

  /** For searches that follow the changes. */
  const ChangeLog& changes() const { return m_changes; }

 private:
  struct Vertex {
    GraphClass classId = 0;
    bool present = false;
    std::vector<Incidence> edges;
  };
  struct Slots {
    std::uint32_t atA, atB;  // where the edge stands in the lists of its two vertices
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
  void detach(VertexId v, std::uint32_t slot);
  void logVertex(VertexId v);
  void logEdge(EdgeId e);

  int m_classes;
  std::vector<Vertex> m_vertices;
  std::vector<Edge> m_edges;
  std::vector<Slots> m_slots;
  std::vector<VertexId> m_freeVertices;
  std::vector<EdgeId> m_freeEdges;
  std::size_t m_vertexCount = 0, m_edgeCount = 0;
  ChangeLog m_changes;
};

}  // namespace colored_graph
