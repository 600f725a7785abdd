#include <colored_graph/ColoredGraph.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace colored_graph {
namespace {

constexpr Length kLargestLength = Length{1} << 62;
constexpr std::size_t kShortestLog = 1024;

[[noreturn]] void reject(const std::string& what) {
  throw std::invalid_argument("ColoredGraph: " + what);
}

void checkLength(Length length) {
  if (length < 0) reject("length " + std::to_string(length) + " is negative");
  if (length > kLargestLength) reject("length " + std::to_string(length) + " is above 2^62");
}

/** An id that was removed before, or a new one at the end of `storage`. */
template <class Id, class T>
Id takeId(std::vector<Id>& freeIds, std::vector<T>& storage) {
  if (freeIds.empty()) {
    storage.emplace_back();
    return static_cast<Id>(storage.size() - 1);
  }
  const Id id = freeIds.back();
  freeIds.pop_back();
  return id;
}

}  // namespace

void ChangeLog::push(VertexId vertex, std::size_t keep) {
  if (m_vertices.size() >= 2 * keep) {
    const std::size_t drop = m_vertices.size() - keep;
    m_vertices.erase(m_vertices.begin(), m_vertices.begin() + static_cast<std::ptrdiff_t>(drop));
    m_dropped += drop;
  }
  m_vertices.push_back(vertex);
}

ColoredGraph::ColoredGraph(int classes) : m_classes(classes) {
  if (classes < 1) reject("at least one class is needed, not " + std::to_string(classes));
}

VertexId ColoredGraph::addVertex(GraphClass id) {
  checkClass(id);
  const VertexId v = takeId(m_freeVertices, m_vertices);
  m_vertices[v].classId = id;
  m_vertices[v].present = true;
  ++m_vertexCount;
  logVertex(v);
  return v;
}

void ColoredGraph::removeVertex(VertexId v) {
  std::vector<Incidence>& edges = m_vertices[checked(v)].edges;
  while (!edges.empty()) removeEdge(edges.back().edge);
  m_vertices[v].present = false;
  --m_vertexCount;
  m_freeVertices.push_back(v);
  logVertex(v);
}

void ColoredGraph::setVertexClass(VertexId v, GraphClass id) {
  Vertex& vertex = m_vertices[checked(v)];
  checkClass(id);
  if (vertex.classId == id) return;
  vertex.classId = id;
  logVertex(v);
  for (const Incidence& i : vertex.edges) logVertex(i.neighbor);
}

EdgeId ColoredGraph::addEdge(VertexId a, VertexId b, EdgeProfile profile) {
  const Length length = checkedLength(profile);
  return insert({a, b, length, EdgeState::Usable, std::move(profile)});
}

EdgeId ColoredGraph::addUnevaluatedEdge(VertexId a, VertexId b, Length minLength) {
  checkLength(minLength);
  return insert({a, b, minLength, EdgeState::Unevaluated, {}});
}

EdgeId ColoredGraph::insert(Edge edge) {
  Vertex& a = m_vertices[checked(edge.a)];
  Vertex& b = m_vertices[checked(edge.b)];
  if (edge.a == edge.b) reject("an edge from vertex " + std::to_string(edge.a) + " to itself");
  const EdgeId e = takeId(m_freeEdges, m_edges);
  m_slots.resize(m_edges.size());
  m_slots[e] = {static_cast<std::uint32_t>(a.edges.size()),
                static_cast<std::uint32_t>(b.edges.size())};
  a.edges.push_back({edge.b, e});
  b.edges.push_back({edge.a, e});
  m_edges[e] = std::move(edge);
  ++m_edgeCount;
  logEdge(e);
  return e;
}

void ColoredGraph::removeEdge(EdgeId e) {
  const Edge& edge = m_edges[checkedEdge(e)];
  logEdge(e);
  detach(edge.a, m_slots[e].atA);
  detach(edge.b, m_slots[e].atB);
  m_edges[e] = Edge{};
  m_freeEdges.push_back(e);
  --m_edgeCount;
}

void ColoredGraph::detach(VertexId v, std::uint32_t slot) {
  std::vector<Incidence>& edges = m_vertices[v].edges;
  edges[slot] = edges.back();
  edges.pop_back();
  if (slot == edges.size()) return;
  const EdgeId moved = edges[slot].edge;
  (m_edges[moved].a == v ? m_slots[moved].atA : m_slots[moved].atB) = slot;
}

void ColoredGraph::setProfile(EdgeId e, EdgeProfile profile) {
  Edge& edge = m_edges[checkedEdge(e)];
  const Length length = checkedLength(profile);
  if (edge.state == EdgeState::Unevaluated && length < edge.length)
    reject("edge " + std::to_string(e) + " is " + std::to_string(length) +
           " long, but was said to be at least " + std::to_string(edge.length));
  edge.length = length;
  edge.state = EdgeState::Usable;
  edge.profile = std::move(profile);
  logEdge(e);
}

void ColoredGraph::setBlocked(EdgeId e) {
  Edge& edge = m_edges[checkedEdge(e)];
  edge.state = EdgeState::Blocked;
  edge.profile.clear();
  logEdge(e);
}

void ColoredGraph::setUnevaluated(EdgeId e, Length minLength) {
  Edge& edge = m_edges[checkedEdge(e)];
  checkLength(minLength);
  edge.length = minLength;
  edge.state = EdgeState::Unevaluated;
  edge.profile.clear();
  logEdge(e);
}

void ColoredGraph::refuseVertex(VertexId v) {
  throw std::out_of_range("ColoredGraph: vertex " + std::to_string(v) + " is not in the graph");
}

void ColoredGraph::refuseEdge(EdgeId e) {
  throw std::out_of_range("ColoredGraph: edge " + std::to_string(e) + " is not in the graph");
}

void ColoredGraph::checkClass(GraphClass id) const {
  if (id >= m_classes)
    reject("class " + std::to_string(id) + " is not one of the " + std::to_string(m_classes) +
           " classes");
}

Length ColoredGraph::checkedLength(const EdgeProfile& profile) const {
  if (profile.empty()) reject("the profile of a usable edge is empty");
  Length total = 0;
  for (const Stretch& stretch : profile) {
    checkClass(stretch.classId);
    checkLength(stretch.length);
    checkLength(total += stretch.length);
  }
  return total;
}

void ColoredGraph::logVertex(VertexId v) {
  m_changes.push(v, std::max(kShortestLog, m_vertices.size()));
}

void ColoredGraph::logEdge(EdgeId e) {
  logVertex(m_edges[e].a);
  logVertex(m_edges[e].b);
}

}  // namespace colored_graph
