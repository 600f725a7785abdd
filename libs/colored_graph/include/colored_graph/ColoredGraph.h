#pragma once
#include <colored_graph/ChangeLog.h>
#include <colored_graph/Edge.h>
#include <colored_graph/EdgeRows.h>

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

namespace colored_graph {

/** One end of an edge, as seen from a vertex. */
struct Incidence {
  VertexId neighbor;
  EdgeId edge;
};

class Incidences;

/** A graph whose vertices have a class and whose edges have a profile of classes. Edges lead both
 * ways unless their tolls close one.
 *
 * Vertices and edges are inserted in O(1) amortized; what is asked of an edge or done to it takes
 * O(degree of its ends). An id stays valid until its vertex or edge is removed; then it may be
 * given out again. Parallel edges are allowed, loops are not. A vertex takes 12 bytes, an edge that
 * is shorter than 1.6 km, without a toll and in one class below 30 takes 28. Every method that
 * takes an id throws std::out_of_range for one that is not in the graph, and leaves the graph as it
 * was whenever it throws. */
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
  EdgeId edgeIdEnd() const { return static_cast<EdgeId>(m_firstEnds.size()); }
  bool containsVertex(VertexId v) const { return v < m_vertices.size() && m_vertices[v].present; }
  bool containsEdge(EdgeId e) const {
    return e < m_firstEnds.size() && m_firstEnds[e] != kNoVertex;
  }

  GraphClass vertexClass(VertexId v) const { return m_vertices[checked(v)].classId; }
  /** The edges at v, whichever way they lead, in no particular order; valid until the graph
   * changes. */
  Incidences incident(VertexId v) const;
  Edge edge(EdgeId e) const;

  /** For searches: the edges at a vertex that is in the graph, which is not checked. */
  [[gnu::always_inline]] EdgeRow row(VertexId v) const { return m_rows.row(m_vertices[v].edges()); }
  /** The edge as its end `v` keeps it. */
  HalfEdge half(EdgeId e, VertexId v) const;
  const WideEdge& wide(const HalfEdge& half) const { return m_wide[half.place()]; }
  EdgeState state(const HalfEdge& half) const;
  bool leads(VertexId v, const HalfEdge& half, Way way) const {
    return half.isWide() ? wide(half).toll(v, way) != kClosed : half.leads(way);
  }
  /** Brings what is known of a vertex near to the processor, without its edges. */
  [[gnu::always_inline]] void prefetch(VertexId v) const { __builtin_prefetch(&m_vertices[v]); }

  /** For searches that follow the changes. */
  const ChangeLog& changes() const { return m_changes; }

 private:
  struct Vertex : EdgeRows::Row {
    bool present = false;
    GraphClass classId = 0;
    const EdgeRows::Row& edges() const { return *this; }
    EdgeRows::Row& edges() { return *this; }
  };
  static_assert(sizeof(Vertex) == 12);

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
  /** An edge's two halves: that of a, that of b. */
  using Halves = std::pair<HalfEdge, HalfEdge>;

  EdgeId insert(VertexId b, WideEdge content);
  void setContent(EdgeId e, VertexId b, WideEdge content);
  Halves store(VertexId b, WideEdge content);
  void releaseWide(const HalfEdge& half);
  Edge asEdge(VertexId a, const HalfEdge& half) const;
  void logVertex(VertexId v);

  int m_classes;
  PagedArray<Vertex> m_vertices;
  PagedArray<VertexId> m_firstEnds;  // of each edge a, or none if the edge is not in the graph
  EdgeRows m_rows;
  std::vector<WideEdge> m_wide;
  std::vector<VertexId> m_freeVertices;
  std::vector<EdgeId> m_freeEdges;
  std::vector<std::uint32_t> m_freeWide;
  std::size_t m_vertexCount = 0, m_edgeCount = 0;
  ChangeLog m_changes;
};

/** The edges at a vertex. */
class Incidences {
 public:
  class Iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = Incidence;
    using difference_type = std::ptrdiff_t;
    using pointer = const Incidence*;
    using reference = Incidence;

    Iterator(const HalfEdge* half, const EdgeId* edge) : m_half(half), m_edge(edge) {}
    Incidence operator*() const { return {m_half->neighbor, *m_edge}; }
    Iterator& operator++() {
      ++m_half;
      ++m_edge;
      return *this;
    }
    bool operator==(const Iterator& o) const { return m_edge == o.m_edge; }
    bool operator!=(const Iterator& o) const { return m_edge != o.m_edge; }

   private:
    const HalfEdge* m_half;
    const EdgeId* m_edge;
  };

  explicit Incidences(const EdgeRow& row) : m_row(row) {}

  std::size_t size() const { return m_row.size; }
  bool empty() const { return m_row.size == 0; }
  Iterator begin() const { return {m_row.halves, m_row.edges}; }
  Iterator end() const { return {m_row.halves + m_row.size, m_row.edges + m_row.size}; }
  Incidence operator[](std::size_t i) const { return {m_row.halves[i].neighbor, m_row.edges[i]}; }
  Incidence front() const { return (*this)[0]; }

 private:
  EdgeRow m_row;
};

inline Incidences ColoredGraph::incident(VertexId v) const { return Incidences(row(checked(v))); }

}  // namespace colored_graph
