#include <colored_graph/ColoredGraph.h>

#include <colored_graph/ChangeLog.h>

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

void checkToll(Length toll) {
  if (toll < 0) reject("toll " + std::to_string(toll) + " is negative");
  if (toll >= kLargestLength && toll != kClosed)
    reject("toll " + std::to_string(toll) + " is 2^62 or more");
}

void checkTolls(const Tolls& tolls) {
  checkToll(tolls.toA);
  checkToll(tolls.toB);
}

/** An id that was removed before, or a new one at the end of `storage`. */
template <class Id, class Storage>
Id takeId(std::vector<Id>& freeIds, Storage& storage) {
  if (freeIds.empty()) {
    storage.emplace_back();
    return static_cast<Id>(storage.size() - 1);
  }
  const Id id = freeIds.back();
  freeIds.pop_back();
  return id;
}

}  // namespace

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
  Vertex& vertex = m_vertices[checked(v)];
  while (!vertex.incident.empty()) removeEdge(vertex.incident.back().edge);
  vertex.present = false;
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
  for (const Incidence& i : incident(v)) logVertex(i.neighbor);
}

EdgeId ColoredGraph::addEdge(VertexId a, VertexId b, EdgeProfile profile, Tolls tolls) {
  const Length length = checkedLength(profile);
  return insert({a, b, length, EdgeState::Usable, tolls, std::move(profile)});
}

EdgeId ColoredGraph::addUnevaluatedEdge(VertexId a, VertexId b, Length minLength, Tolls tolls) {
  checkLength(minLength);
  return insert({a, b, minLength, EdgeState::Unevaluated, tolls, {}});
}

EdgeId ColoredGraph::insert(Edge edge) {
  const VertexId a = checked(edge.a), b = checked(edge.b);
  if (a == b) reject("an edge from vertex " + std::to_string(a) + " to itself");
  checkTolls(edge.tolls);
  const EdgeId e = takeId(m_freeEdges, m_edges);
  m_edges[e] = std::move(edge);
  m_vertices[a].incident.push_back({b, e});
  m_vertices[b].incident.push_back({a, e});
  ++m_edgeCount;
  logVertex(a);
  logVertex(b);
  return e;
}

void ColoredGraph::removeEdge(EdgeId e) {
  const VertexId a = edge(e).a, b = edge(e).b;
  for (const VertexId v : {a, b}) {
    Incidences& at = m_vertices[v].incident;
    *std::find_if(at.begin(), at.end(), [e](const Incidence& i) { return i.edge == e; }) =
        at.back();
    at.pop_back();
    logVertex(v);
  }
  m_edges[e] = Edge();
  m_freeEdges.push_back(e);
  --m_edgeCount;
}

void ColoredGraph::setContent(EdgeId e, EdgeState state, Length length, EdgeProfile profile) {
  Edge& edge = m_edges[checkedEdge(e)];
  edge.state = state;
  edge.length = length;
  edge.profile = std::move(profile);
  logVertex(edge.a);
  logVertex(edge.b);
}

void ColoredGraph::setProfile(EdgeId e, EdgeProfile profile) {
  const Edge& before = edge(e);
  const Length length = checkedLength(profile);
  if (before.state == EdgeState::Unevaluated && length < before.length)
    reject("edge " + std::to_string(e) + " is " + std::to_string(length) +
           " long, but was said to be at least " + std::to_string(before.length));
  setContent(e, EdgeState::Usable, length, std::move(profile));
}

void ColoredGraph::setBlocked(EdgeId e) { setContent(e, EdgeState::Blocked, edge(e).length, {}); }

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
  m_changes.push(v, std::max(kShortestLog, m_vertices.size() / 2));
}

void ChangeLog::push(VertexId vertex, std::size_t keep) {
  if (m_vertices.size() >= 2 * keep) {
    const std::size_t drop = m_vertices.size() - keep;
    m_vertices.erase(m_vertices.begin(), m_vertices.begin() + static_cast<std::ptrdiff_t>(drop));
    m_dropped += drop;
  }
  m_vertices.push_back(vertex);
}

}  // namespace colored_graph
