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

void checkToll(Length toll) {
  if (toll < 0) reject("toll " + std::to_string(toll) + " is negative");
  if (toll >= kLargestLength && toll != kClosed)
    reject("toll " + std::to_string(toll) + " is 2^62 or more");
}

void checkTolls(const Tolls& tolls) {
  checkToll(tolls.toA);
  checkToll(tolls.toB);
}

/** Whether half edges have room for it. */
bool isNarrow(const WideEdge& edge) {
  const auto isFree = [](Length toll) { return toll == 0 || toll == kClosed; };
  constexpr unsigned kNarrowClasses = HalfEdge::kKinds - HalfEdge::kFirstClass;
  return edge.length <= HalfEdge::kLongest && isFree(edge.tolls.toA) && isFree(edge.tolls.toB) &&
         (edge.state != EdgeState::Usable ||
          (edge.profile.size() == 1 && edge.profile.front().classId < kNarrowClasses));
}

unsigned kindOf(const WideEdge& narrow) {
  if (narrow.state == EdgeState::Unevaluated) return HalfEdge::kUnevaluated;
  if (narrow.state == EdgeState::Blocked) return HalfEdge::kBlocked;
  return HalfEdge::kFirstClass + narrow.profile.front().classId;
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
  while (vertex.size > 0) removeEdge(row(v).edges[vertex.size - 1]);
  m_rows.release(vertex.edges());
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
  return insert(b, {a, EdgeState::Usable, length, tolls, std::move(profile)});
}

EdgeId ColoredGraph::addUnevaluatedEdge(VertexId a, VertexId b, Length minLength, Tolls tolls) {
  checkLength(minLength);
  return insert(b, {a, EdgeState::Unevaluated, minLength, tolls, {}});
}

EdgeId ColoredGraph::insert(VertexId b, WideEdge content) {
  const VertexId a = content.a;
  Vertex& atA = m_vertices[checked(a)];
  Vertex& atB = m_vertices[checked(b)];
  if (a == b) reject("an edge from vertex " + std::to_string(a) + " to itself");
  checkTolls(content.tolls);
  const EdgeId e = takeId(m_freeEdges, m_firstEnds);
  m_firstEnds[e] = a;
  const Halves halves = store(b, std::move(content));
  m_rows.push(atA.edges(), halves.first, e);
  m_rows.push(atB.edges(), halves.second, e);
  ++m_edgeCount;
  logVertex(a);
  logVertex(b);
  return e;
}

ColoredGraph::Halves ColoredGraph::store(VertexId b, WideEdge content) {
  const VertexId a = content.a;
  if (isNarrow(content)) {
    const unsigned kind = kindOf(content);
    const bool toA = content.tolls.toA != kClosed, toB = content.tolls.toB != kClosed;
    return {HalfEdge::narrow(b, kind, content.length, toB, toA),
            HalfEdge::narrow(a, kind, content.length, toA, toB)};
  }
  const std::uint32_t place = takeId(m_freeWide, m_wide);
  m_wide[place] = std::move(content);
  return {HalfEdge::wide(b, place), HalfEdge::wide(a, place)};
}

void ColoredGraph::releaseWide(const HalfEdge& half) {
  if (!half.isWide()) return;
  m_wide[half.place()] = WideEdge();
  m_freeWide.push_back(half.place());
}

void ColoredGraph::removeEdge(EdgeId e) {
  const VertexId a = m_firstEnds[checkedEdge(e)], b = half(e, a).neighbor;
  releaseWide(half(e, a));
  for (const VertexId v : {a, b}) {
    EdgeRows::Row& edges = m_vertices[v].edges();
    m_rows.remove(edges, m_rows.find(edges, e));
    logVertex(v);
  }
  m_firstEnds[e] = kNoVertex;
  m_freeEdges.push_back(e);
  --m_edgeCount;
}

void ColoredGraph::setContent(EdgeId e, VertexId b, WideEdge content) {
  const VertexId a = content.a;
  releaseWide(half(e, a));
  const Halves halves = store(b, std::move(content));
  const auto set = [&](VertexId v, const HalfEdge& half) {
    const EdgeRows::Row& edges = m_vertices[v].edges();
    m_rows.half(edges, m_rows.find(edges, e)) = half;
    logVertex(v);
  };
  set(a, halves.first);
  set(b, halves.second);
}

void ColoredGraph::setProfile(EdgeId e, EdgeProfile profile) {
  const Edge before = edge(e);
  const Length length = checkedLength(profile);
  if (before.state == EdgeState::Unevaluated && length < before.length)
    reject("edge " + std::to_string(e) + " is " + std::to_string(length) +
           " long, but was said to be at least " + std::to_string(before.length));
  setContent(e, before.b, {before.a, EdgeState::Usable, length, before.tolls, std::move(profile)});
}

void ColoredGraph::setBlocked(EdgeId e) {
  const Edge before = edge(e);
  setContent(e, before.b, {before.a, EdgeState::Blocked, before.length, before.tolls, {}});
}

HalfEdge ColoredGraph::half(EdgeId e, VertexId v) const {
  return row(v).halves[m_rows.find(m_vertices[v].edges(), e)];
}

EdgeState ColoredGraph::state(const HalfEdge& half) const {
  if (half.isWide()) return wide(half).state;
  if (half.kind() == HalfEdge::kUnevaluated) return EdgeState::Unevaluated;
  return half.kind() == HalfEdge::kBlocked ? EdgeState::Blocked : EdgeState::Usable;
}

Edge ColoredGraph::edge(EdgeId e) const {
  const VertexId a = m_firstEnds[checkedEdge(e)];
  return asEdge(a, half(e, a));
}

Edge ColoredGraph::asEdge(VertexId a, const HalfEdge& half) const {
  if (half.isWide()) {
    const WideEdge& content = wide(half);
    return {
        a, half.neighbor, content.length, content.state, content.tolls, Stretches(content.profile)};
  }
  Edge edge{a, half.neighbor, half.length(), state(half), {}, {}};
  if (!half.leads(Way::Out)) edge.tolls.toB = kClosed;
  if (!half.leads(Way::In)) edge.tolls.toA = kClosed;
  if (edge.state == EdgeState::Usable) {
    const unsigned id = half.kind() - HalfEdge::kFirstClass;
    edge.profile = Stretches(Stretch{static_cast<GraphClass>(id), edge.length});
  }
  return edge;
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
  m_changes.push(v, std::max(kShortestLog, m_vertices.size() / 2));
}

}  // namespace colored_graph
