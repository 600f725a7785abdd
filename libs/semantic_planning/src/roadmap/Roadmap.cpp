#include <semantic_planning/roadmap/Roadmap.h>

#include <semantic_planning/roadmap/MrptGraph.h>
#include <semantic_planning/roadmap/RoadmapOptions.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "NearestPoses.h"

namespace semantic_planning {

using colored_graph::Edge;
using colored_graph::EdgeProfile;
using colored_graph::EdgeState;
using colored_graph::Incidence;
using colored_graph::Length;

namespace {

bool isSame(const EdgeProfile& l, const EdgeProfile& r) {
  return std::equal(l.begin(), l.end(), r.begin(), r.end(), [](const auto& a, const auto& b) {
    return a.classId == b.classId && a.length == b.length;
  });
}

/** What driving a curve costs beyond its length. */
Length tollOf(const ReedsSheppCurve& curve, const MotionCost& price) {
  return colored_graph::lengthDown(std::max(0.0, price.of(curve) - curve.length()));
}

/** More vertices want more neighbors, for paths to become better with them. */
int neighborsFor(const RoadmapOptions& options) {
  constexpr double kBase = 1000, kMore = 6;
  const double doublings = std::log2(std::max(kBase, double(options.vertices)) / kBase);
  return options.neighbors + static_cast<int>(std::lround(kMore * doublings));
}

}  // namespace

Roadmap::Roadmap(const CollisionChecker& checker, const RoadmapOptions& options)
    : m_checker(checker),
      m_graph(checker.order().classes()),
      m_nearest(std::make_unique<NearestPoses>(checker.reedsShepp(), neighborsFor(options),
                                               RoadmapOptions::kLongestEdge)),
      m_queryNeighbors(2 * static_cast<std::size_t>(neighborsFor(options))),
      m_mostEdges(options.maxEdges) {}

Roadmap::~Roadmap() = default;

void Roadmap::keepPose(VertexId v, const GroundPose& pose) {
  if (v >= m_poses.size()) m_poses.resize(v + 1);
  m_poses[v] = pose;
}

std::vector<Roadmap::VertexId> Roadmap::replace(const std::vector<VertexId>& removed,
                                                const std::vector<GroundPose>& poses,
                                                const std::vector<ClassId>& classes) {
  for (const VertexId v : removed) m_graph.removeVertex(v);
  std::vector<VertexId> ids;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    ids.push_back(m_graph.addVertex(classes[i]));
    keepPose(ids.back(), poses[i]);
  }
  m_nearest->replace(removed, ids, poses);
  reconcile();
  for (const VertexId query : m_queryVertices) reconcileQueryVertex(query);
  return ids;
}

Roadmap::VertexId Roadmap::addQueryVertex(const GroundPose& pose) {
  const VertexId v = m_graph.addVertex(m_checker.classAt(pose));
  keepPose(v, pose);
  m_queryVertices.insert(v);
  reconcileQueryVertex(v);
  return v;
}

void Roadmap::removeQueryVertex(VertexId v) {
  m_graph.removeVertex(v);
  m_queryVertices.erase(v);
}

/** Unless they are. */
void Roadmap::connect(VertexId a, VertexId b) {
  const auto& edges = m_graph.incident(a);
  if (std::none_of(edges.begin(), edges.end(), [b](const auto& i) { return i.neighbor == b; }))
    link(a, b);
}

void Roadmap::link(VertexId a, VertexId b) {
  const MotionCost& price = m_checker.motionCost();
  if (!price.canReverse()) {
    linkOneWay(a, b);
    return linkOneWay(b, a);
  }
  const ReedsSheppCurve curve = PosePair(pose(a), pose(b)).curveFrom(pose(a), price);
  const colored_graph::Tolls tolls{tollOf(curve, price), tollOf(curve.reversed(), price)};
  m_graph.addUnevaluatedEdge(a, b, colored_graph::lengthDown(curve.length()), tolls);
}

void Roadmap::linkOneWay(VertexId from, VertexId to) {
  const MotionCost& price = m_checker.motionCost();
  const ReedsSheppCurve curve = price.shortest(pose(from).pose, pose(to).pose);
  if (curve.length() > RoadmapOptions::kLongestEdge) return;
  const colored_graph::Tolls tolls{tollOf(curve, price), colored_graph::kClosed};
  m_graph.addUnevaluatedEdge(from, to, colored_graph::lengthDown(curve.length()), tolls);
}

/** The pairs that are to have edges. */
std::set<std::pair<Roadmap::VertexId, Roadmap::VertexId>> Roadmap::neighbors() const {
  using Worth = std::tuple<std::size_t, double, PosePair, VertexId, VertexId>;
  std::vector<Worth> pairs;
  std::set<std::pair<VertexId, VertexId>> best;
  for (VertexId a = 0; a < m_graph.vertexIdEnd(); ++a) {
    if (!m_nearest->contains(a)) continue;
    const auto& nearest = m_nearest->of(a);
    for (std::size_t i = 0; i < nearest.size(); ++i) {
      const auto [low, high] = std::minmax(a, nearest[i].id);
      if (m_mostEdges == 0)
        best.emplace(low, high);
      else
        pairs.emplace_back(i, nearest[i].distance, PosePair(pose(low), pose(high)), low, high);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  for (const auto& [place, distance, poses, a, b] : pairs)
    if (best.size() < m_mostEdges) best.emplace(a, b);
  return best;
}

void Roadmap::reconcile() {
  const auto wanted = neighbors();
  for (EdgeId e = 0; e < m_graph.edgeIdEnd(); ++e) {
    if (!m_graph.containsEdge(e)) continue;
    const auto [a, b] = std::minmax(m_graph.edge(e).a, m_graph.edge(e).b);
    if (m_nearest->contains(a) && m_nearest->contains(b) && !wanted.count({a, b}))
      m_graph.removeEdge(e);
  }
  for (const auto& [a, b] : wanted) connect(a, b);
}

void Roadmap::reconcileQueryVertex(VertexId query) {
  std::set<VertexId> wanted;
  for (const auto& n : m_nearest->nearestTo(pose(query), m_queryNeighbors)) wanted.insert(n.id);
  for (const VertexId other : m_queryVertices)
    if (other != query && PosePair(pose(query), pose(other)).distance(m_checker.reedsShepp()) <=
                              RoadmapOptions::kLongestEdge)
      wanted.insert(other);
  const colored_graph::Incidences present = m_graph.incident(query);  // the graph changes below
  for (const Incidence& i : present)
    if (!wanted.count(i.neighbor)) m_graph.removeEdge(i.edge);
  for (const VertexId other : wanted) connect(query, other);
}

void Roadmap::refresh(const std::vector<Column>& changedTiles) {
  const std::set<Column> changed(changedTiles.begin(), changedTiles.end());
  for (EdgeId e = 0; e < m_graph.edgeIdEnd(); ++e)
    if (m_graph.containsEdge(e) && m_graph.edge(e).state != EdgeState::Unevaluated &&
        mayDependOn(changed, e))
      reevaluate(e);
}

/** A curve stays within half its length of the middle between its ends. */
bool Roadmap::mayDependOn(const std::set<Column>& tiles, EdgeId e) const {
  const PosePair poses = ends(e);
  const auto &a = poses.first.pose, &b = poses.second.pose;
  const double x = (a.x + b.x) / 2, y = (a.y + b.y) / 2;
  const double far = colored_graph::toMeters(m_graph.edge(e).length + 1) / 2 + m_checker.reach();
  const Ground& ground = m_checker.ground();
  const Column low = tileOf(ground.columnAt(x - far, y - far)),
               high = tileOf(ground.columnAt(x + far, y + far));
  for (Column tile = low; tile.y <= high.y; ++tile.y)
    for (tile.x = low.x; tile.x <= high.x; ++tile.x)
      if (tiles.count(tile)) return true;
  return false;
}

void Roadmap::reevaluate(EdgeId e) {
  const Edge before = m_graph.edge(e);
  auto profile = evaluate(e);
  const bool usable = before.state == EdgeState::Usable;
  if (profile ? usable && isSame(*profile, before.profile) : !usable) return;
  if (profile)
    m_graph.setProfile(e, std::move(*profile));
  else
    m_graph.setBlocked(e);
}

PosePair Roadmap::ends(EdgeId e) const {
  const Edge edge = m_graph.edge(e);
  return m_checker.motionCost().canReverse() ? PosePair(pose(edge.a), pose(edge.b))
                                             : PosePair::oneWay(pose(edge.a), pose(edge.b));
}

ReedsSheppCurve Roadmap::curve(EdgeId e, VertexId from) const {
  return ends(e).curveFrom(pose(from), m_checker.motionCost());
}

std::optional<EdgeProfile> Roadmap::evaluate(EdgeId e) const {
  const PosePair poses = ends(e);
  return m_checker.profile(poses.first, poses.second);
}

Length Roadmap::lengthBound(VertexId a, VertexId b) const {
  return colored_graph::lengthDown(m_checker.reedsShepp().lowerBound(pose(a).pose, pose(b).pose));
}

using colored_graph::EdgeId;
using colored_graph::VertexId;
using mrpt::poses::CPose2D;

ClassNetwork toNetwork(const Roadmap& roadmap, const std::vector<std::string>& classNames) {
  const colored_graph::ColoredGraph& graph = roadmap.graph();
  ClassNetwork network;
  for (VertexId v = 0; v < graph.vertexIdEnd(); ++v) {
    if (!graph.containsVertex(v)) continue;
    auto& node = network.nodes[v];
    static_cast<CPose2D&>(node) = CPose2D(roadmap.pose(v).pose);
    node.name = classNames.at(graph.vertexClass(v));
  }
  for (EdgeId e = 0; e < graph.edgeIdEnd(); ++e) {
    if (!graph.containsEdge(e) || graph.edge(e).state == EdgeState::Blocked) continue;
    const VertexId a = graph.edge(e).a, b = graph.edge(e).b;
    network.insertEdge(a, b, CPose2D(roadmap.pose(b).pose) - CPose2D(roadmap.pose(a).pose));
  }
  if (!network.nodes.empty()) network.root = network.nodes.begin()->first;
  return network;
}

using strict_files::atLeast;
using strict_files::Choices;

const Choices<GraphKind>& choicesOf(GraphKind) {
  static const Choices<GraphKind> choices = {{"compressed", GraphKind::Compressed},
                                             {"leaves", GraphKind::Leaves},
                                             {"halton", GraphKind::Halton},
                                             {"halton_drivable", GraphKind::HaltonDrivable}};
  return choices;
}

const char* nameOf(GraphKind kind) { return strict_files::nameIn(choicesOf(kind), kind); }

bool isOfTree(GraphKind kind) { return kind == GraphKind::Compressed || kind == GraphKind::Leaves; }

void RoadmapOptions::describe(strict_files::OptionList& list) {
  strict_files::Range buffers = atLeast(0);
  buffers.withInfinity = true;
  list.add("graph", kind, "",
           "vertices of the graph: cells of the compressed tree, leaves of the map, N draws of a "
           "Halton sequence, or draws until N are on drivable ground");
  list.add("vertices", vertices, "", "number of vertices (N); 0: all that the map has");
  list.add("buffer", buffer, "m", buffers,
           "greatest distance of vertices from the line between start and goal");
}

void RoadmapOptions::validate() const { strict_files::checkOptions(*this, "RoadmapOptions"); }

}  // namespace semantic_planning
