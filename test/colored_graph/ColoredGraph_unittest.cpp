#include <colored_graph/ClassOrder.h>
#include <colored_graph/ColoredGraph.h>
#include <colored_graph/Edge.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <string>

using namespace colored_graph;

namespace {

ColoredGraph triangle() {
  ColoredGraph graph(3);
  for (GraphClass id = 0; id < 3; ++id) graph.addVertex(id);
  graph.addEdge(0, 1, {{0, 10}});
  graph.addEdge(1, 2, {{1, 20}, {2, 5}});
  graph.addUnevaluatedEdge(2, 0, 30);
  return graph;
}

/** What the log says since `from`. */
std::set<VertexId> logged(const ColoredGraph& graph, std::uint64_t from) {
  std::set<VertexId> vertices;
  for (auto i = from; i < graph.changes().end(); ++i) vertices.insert(graph.changes()[i]);
  return vertices;
}

/** A graph of sets and maps, to compare with. */
struct Reference {
  std::set<VertexId> vertices;
  std::map<EdgeId, std::pair<VertexId, VertexId>> edges;

  void removeVertex(VertexId v) {
    vertices.erase(v);
    for (auto it = edges.begin(); it != edges.end();)
      it = it->second.first == v || it->second.second == v ? edges.erase(it) : std::next(it);
  }
};

void expectSame(const ColoredGraph& graph, const Reference& reference) {
  RC_ASSERT(graph.vertexCount() == reference.vertices.size());
  RC_ASSERT(graph.edgeCount() == reference.edges.size());
  std::map<VertexId, std::set<EdgeId>> incident;
  for (const auto& [e, ends] : reference.edges) {
    RC_ASSERT(graph.edge(e).a == ends.first);
    RC_ASSERT(graph.edge(e).b == ends.second);
    incident[ends.first].insert(e);
    incident[ends.second].insert(e);
  }
  for (const VertexId v : reference.vertices) {
    std::set<EdgeId> listed;
    for (const Incidence& i : graph.incident(v)) {
      RC_ASSERT(listed.insert(i.edge).second);
      RC_ASSERT(graph.edge(i.edge).other(v) == i.neighbor);
    }
    RC_ASSERT(listed == incident[v]);
  }
}

template <class T>
typename T::value_type anyOf(const T& container) {
  return *std::next(container.begin(),
                    *rc::gen::inRange<int>(0, static_cast<int>(container.size())));
}

void changeAtRandom(ColoredGraph& graph, Reference& reference) {
  const int what = *rc::gen::inRange(0, 8);
  if (what < 3 || reference.vertices.size() < 2) {
    reference.vertices.insert(graph.addVertex(0));
  } else if (what < 6) {
    const VertexId a = anyOf(reference.vertices), b = anyOf(reference.vertices);
    if (a != b) reference.edges[graph.addEdge(a, b, {{0, 1}})] = {a, b};
  } else if (what == 6 && !reference.edges.empty()) {
    const EdgeId e = anyOf(reference.edges).first;
    graph.removeEdge(e);
    reference.edges.erase(e);
  } else {
    const VertexId v = anyOf(reference.vertices);
    graph.removeVertex(v);
    reference.removeVertex(v);
  }
}

TEST(ColoredGraph, equalsSetsAndMapsAfterAnyChanges) {
  EXPECT_TRUE(rc::check([] {
    ColoredGraph graph(1);
    Reference reference;
    for (int changes = *rc::gen::inRange(1, 120); changes > 0; --changes)
      changeAtRandom(graph, reference);
    expectSame(graph, reference);
  }));
}

TEST(ColoredGraph, givesRemovedIdsOutAgainSoThatItDoesNotGrow) {
  ColoredGraph graph = triangle();
  for (int i = 0; i < 1000; ++i) {
    graph.removeVertex(1);
    const VertexId v = graph.addVertex(1);
    graph.addEdge(v, 0, {{0, 10}});
    graph.addEdge(v, 2, {{0, 10}});
  }
  EXPECT_EQ(graph.vertexIdEnd(), 3u);
  EXPECT_EQ(graph.edgeIdEnd(), 3u);
}

TEST(ColoredGraph, logsTheVerticesAtWhoseEdgesSomethingChanged) {
  ColoredGraph graph = triangle();
  const VertexId lonely = graph.addVertex(0);
  const auto changesOf = [&](const auto& change) {
    const std::uint64_t before = graph.changes().end();
    change();
    return logged(graph, before);
  };
  using Set = std::set<VertexId>;
  EXPECT_EQ(changesOf([&] { graph.setProfile(0, {{1, 11}}); }), (Set{0, 1}));
  EXPECT_EQ(changesOf([&] { graph.setBlocked(0); }), (Set{0, 1}));
  EXPECT_EQ(changesOf([&] { graph.addEdge(lonely, 2, {{0, 1}}); }), (Set{2, lonely}));
  EXPECT_EQ(changesOf([&] { graph.setVertexClass(2, 1); }), (Set{0, 1, 2, lonely}));
  EXPECT_EQ(changesOf([&] { graph.setVertexClass(2, 1); }), Set{});
  EXPECT_EQ(changesOf([&] { graph.removeEdge(0); }), (Set{0, 1}));
  EXPECT_EQ(changesOf([&] { graph.removeVertex(2); }), (Set{0, 1, 2, lonely}));
}

TEST(ColoredGraph, logIsBoundedAndKeepsTheLatest) {
  ColoredGraph graph = triangle();
  for (int i = 0; i < 10000; ++i) graph.setVertexClass(0, static_cast<GraphClass>(i % 2 + 1));
  const ChangeLog& log = graph.changes();
  EXPECT_GT(log.begin(), 20000u);
  EXPECT_LE(log.end() - log.begin(), 2048u);
  EXPECT_GE(log.end() - log.begin(), 1024u);
  EXPECT_EQ(logged(graph, log.end() - 3), (std::set<VertexId>{0, 1, 2}));
}

TEST(ColoredGraph, refusesUnknownIdsAndThoseThatWereRemoved) {
  ColoredGraph graph = triangle();
  const VertexId removed = graph.addVertex(0);
  const EdgeId removedEdge = graph.addEdge(0, removed, {{0, 1}});
  graph.removeVertex(removed);
  const auto log = graph.changes().end();
  for (const VertexId v : {removed, VertexId{4}, kNoVertex}) {
    EXPECT_THROW(graph.removeVertex(v), std::out_of_range);
    EXPECT_THROW(graph.setVertexClass(v, 0), std::out_of_range);
    EXPECT_THROW(graph.vertexClass(v), std::out_of_range);
    EXPECT_THROW(graph.incident(v), std::out_of_range);
    EXPECT_THROW(graph.addEdge(0, v, {{0, 1}}), std::out_of_range);
    EXPECT_THROW(graph.addUnevaluatedEdge(v, 0, 1), std::out_of_range);
  }
  for (const EdgeId e : {removedEdge, EdgeId{4}, kNoEdge}) {
    EXPECT_THROW(graph.removeEdge(e), std::out_of_range);
    EXPECT_THROW(graph.edge(e), std::out_of_range);
    EXPECT_THROW(graph.setProfile(e, {{0, 1}}), std::out_of_range);
    EXPECT_THROW(graph.setBlocked(e), std::out_of_range);
  }
  EXPECT_EQ(graph.edgeCount(), 3u);
  EXPECT_EQ(graph.changes().end(), log);
}

TEST(ColoredGraph, refusesBadProfilesAndStaysAsItWas) {
  ColoredGraph graph = triangle();
  const auto log = graph.changes().end();
  const Length huge = std::numeric_limits<Length>::max();
  for (const EdgeProfile& profile : std::vector<EdgeProfile>{{},
                                                             {{0, -1}},
                                                             {{3, 1}},
                                                             {{0, 1}, {7, 0}},
                                                             {{0, huge}},
                                                             {{0, huge / 2}, {1, huge / 2}}}) {
    EXPECT_THROW(graph.addEdge(0, 1, profile), std::invalid_argument);
    EXPECT_THROW(graph.setProfile(0, profile), std::invalid_argument);
  }
  EXPECT_THROW(graph.addUnevaluatedEdge(0, 1, -1), std::invalid_argument);
  EXPECT_THROW(graph.addEdge(1, 1, {{0, 1}}), std::invalid_argument);
  EXPECT_THROW(graph.addUnevaluatedEdge(1, 1, 1), std::invalid_argument);
  for (const Tolls& tolls :
       {Tolls{-1, 0}, Tolls{0, -1}, Tolls{Length{1} << 62, 0}, Tolls{0, huge - 1}}) {
    EXPECT_THROW(graph.addEdge(0, 1, {{0, 1}}, tolls), std::invalid_argument);
    EXPECT_THROW(graph.addUnevaluatedEdge(0, 1, 1, tolls), std::invalid_argument);
  }
  EXPECT_THROW(graph.addVertex(3), std::invalid_argument);
  EXPECT_THROW(graph.setVertexClass(0, 3), std::invalid_argument);
  EXPECT_THROW(ColoredGraph(0), std::invalid_argument);
  EXPECT_EQ(graph.edgeCount(), 3u);
  EXPECT_EQ(graph.vertexCount(), 3u);
  EXPECT_EQ(graph.edge(0).length, 10);
  EXPECT_EQ(graph.edge(0).profile.size(), 1u);
  EXPECT_EQ(graph.changes().end(), log);
}

TEST(ColoredGraph, namesTheEdgeThatIsShorterThanItsBound) {
  ColoredGraph graph = triangle();
  try {
    graph.setProfile(2, {{0, 29}});
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "ColoredGraph: edge 2 is 29 long, but was said to be at least 30");
  }
  EXPECT_EQ(graph.edge(2).state, EdgeState::Unevaluated);
  graph.setProfile(2, {{0, 30}});
  graph.setProfile(2, {{0, 29}});  // evaluated edges may change in any way
  EXPECT_EQ(graph.edge(2).length, 29);
}

TEST(Length, roundsEdgesUpAndBoundsDown) {
  EXPECT_EQ(lengthUp(0.00011), 2);
  EXPECT_EQ(lengthDown(0.00019), 1);
  EXPECT_EQ(lengthUp(0), 0);
  EXPECT_EQ(lengthDown(0), 0);
  EXPECT_DOUBLE_EQ(toMeters(12345), 1.2345);
}

TEST(Length, roundingNoiseAtAWholeUnitDoesNotCount) {
  EXPECT_EQ(lengthUp(0.1 + 0.2), 3000);    // 0.30000000000000004
  EXPECT_EQ(lengthDown(0.8 - 0.5), 3000);  // 0.30000000000000004
  EXPECT_EQ(lengthDown(0.9 - 0.6), 3000);  // 0.30000000000000004 or 0.29999999999999998
  EXPECT_EQ(lengthDown(0.4 - 0.1), 3000);
  EXPECT_EQ(lengthDown(1.1 - 0.8), 3000);
}

TEST(Length, roundedLinesKeepTheTriangleInequality) {
  EXPECT_TRUE(rc::check([] {
    const auto coordinate = [] { return *rc::gen::inRange(-3000, 3000) * 0.1; };
    const double ax = coordinate(), ay = coordinate(), bx = coordinate(), by = coordinate();
    const double t = *rc::gen::inRange(-10, 20) * 0.1;  // c on the line through a and b
    const double cx = ax + t * (bx - ax), cy = ay + t * (by - ay);
    const double ab = std::hypot(ax - bx, ay - by), bc = std::hypot(bx - cx, by - cy),
                 ac = std::hypot(ax - cx, ay - cy);
    RC_ASSERT(lengthDown(ac) <= lengthUp(ab) + lengthDown(bc));
    RC_ASSERT(lengthDown(bc) <= lengthUp(ab) + lengthDown(ac));
  }));
}

TEST(Length, refusesWhatIsNoLength) {
  for (const double meters :
       {-1e-9, -1.0, std::nan(""), 1e15, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(lengthUp(meters), std::invalid_argument) << meters;
    EXPECT_THROW(lengthDown(meters), std::invalid_argument) << meters;
  }
}

/** The message of the exception that making this order throws. */
std::string refusal(int classes, const std::vector<std::vector<GraphClass>>& bestToWorst) {
  try {
    ClassOrder(classes, bestToWorst);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST(ClassOrder, ranksClassesAndForbidsTheRest) {
  const ClassOrder order(5, {{3}, {0, 4}, {1}});
  EXPECT_EQ(order.classes(), 5);
  EXPECT_EQ(order.ranks(), 3);
  EXPECT_EQ(order.rank(3), 0);
  EXPECT_EQ(order.rank(0), 1);
  EXPECT_EQ(order.rank(4), 1);
  EXPECT_EQ(order.rank(1), 2);
  EXPECT_EQ(order.rank(2), kForbidden);
}

TEST(ClassOrder, saysWhatIsWrongWithAnOrder) {
  EXPECT_EQ(refusal(0, {{0}}), "ClassOrder: a graph has at least one class, not 0");
  EXPECT_EQ(refusal(3, {}), "ClassOrder: the order is empty: every edge would be forbidden");
  EXPECT_EQ(refusal(3, {{0}, {}}), "ClassOrder: rank 1 has no class");
  EXPECT_EQ(refusal(3, {{0}, {3}}), "ClassOrder: class 3 is not one of the 3 classes");
  EXPECT_EQ(refusal(3, {{0}, {1}, {0}}), "ClassOrder: class 0 is named twice");
  EXPECT_EQ(refusal(3, {{1, 1}}), "ClassOrder: class 1 is named twice");
}

TEST(ClassOrder, hasSixteenRanksAtMost) {
  std::vector<std::vector<GraphClass>> ranks;
  for (GraphClass id = 0; id < 16; ++id) ranks.push_back({id});
  EXPECT_EQ(refusal(17, ranks), "accepted");
  ranks.push_back({16});
  EXPECT_EQ(refusal(17, ranks), "ClassOrder: 17 ranks, at most 16");
}
