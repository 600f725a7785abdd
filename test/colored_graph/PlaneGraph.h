#pragma once
#include <colored_graph/ColoredGraph.h>
#include <colored_graph/CostModel.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "EdgeChanges.h"

/** A random graph on points of a coarse grid, so that points coincide (edges of length 0) and
 * lengths tie, with a consistent lower bound of lengths. */
class PlaneGraph {
 public:
  static constexpr int kClasses = 5;

  PlaneGraph(unsigned seed, int cells) : m_random(seed), m_cells(cells) {}

  void addVertex() {
    const colored_graph::VertexId v = graph.addVertex(randomClass());
    if (v == m_points.size()) m_points.emplace_back();
    m_points[v] = {below(m_cells) * kSpacing, below(m_cells) * kSpacing};
  }

  /** An edge between two vertices within `reach` cells, or none if they are apart or the same. */
  void addEdge(double reach) {
    const auto a = randomVertex(), b = randomVertex();
    if (a == b || meters(a, b) > reach * kSpacing) return;
    const auto e = graph.addEdge(a, b, randomProfile(a, b));
    if (below(12) == 0) graph.setBlocked(e);
  }

  /** 1 to 3 stretches; never shorter than the straight line, often just as long. */
  colored_graph::EdgeProfile randomProfile(colored_graph::VertexId a, colored_graph::VertexId b) {
    using colored_graph::Length;
    Length rest = colored_graph::lengthUp(meters(a, b)) + std::max(0, below(20) - 12);
    colored_graph::EdgeProfile profile;
    for (int stretches = 1 + below(3); stretches > 1; --stretches) {
      const Length part = below(static_cast<int>(rest) + 1);
      profile.push_back({randomClass(), part});
      rest -= part;
    }
    profile.push_back({randomClass(), rest});
    return profile;
  }

  /** Every third edge gets tolls, of these every third leads one way. */
  void addTolls() {
    for (colored_graph::EdgeId e = 0; e < graph.edgeIdEnd(); ++e)
      if (graph.containsEdge(e) && below(3) == 0) setTolls(graph, e, randomTolls());
  }
  colored_graph::Tolls randomTolls() {
    const colored_graph::Length toA = below(30), toB = below(30);
    const int oneWay = below(6);
    return {oneWay == 0 ? colored_graph::kClosed : toB, oneWay == 1 ? colored_graph::kClosed : toA};
  }

  /** Every class in the order with equal chances, two of three times in a rank of its own. */
  colored_graph::ClassOrder randomOrder() {
    std::vector<colored_graph::GraphClass> ids(kClasses);
    std::iota(ids.begin(), ids.end(), colored_graph::GraphClass{0});
    std::shuffle(ids.begin(), ids.end(), m_random);
    ids.resize(kClasses - below(3));
    std::vector<std::vector<colored_graph::GraphClass>> ranks;
    for (const auto id : ids) {
      if (ranks.empty() || below(3) > 0) ranks.emplace_back();
      ranks.back().push_back(id);
    }
    return {kClasses, ranks};
  }

  /** Straight line, rounded down. */
  colored_graph::Length bound(colored_graph::VertexId a, colored_graph::VertexId b) const {
    return colored_graph::lengthDown(meters(a, b));
  }

  colored_graph::GraphClass randomClass() {
    return static_cast<colored_graph::GraphClass>(below(kClasses));
  }
  int below(int end) { return static_cast<int>(m_random() % static_cast<unsigned>(end)); }

  colored_graph::VertexId randomVertex() {
    for (;;) {
      const auto v =
          static_cast<colored_graph::VertexId>(below(static_cast<int>(graph.vertexIdEnd())));
      if (graph.containsVertex(v)) return v;
    }
  }
  colored_graph::EdgeId randomEdge() {
    for (;;) {
      const auto e = static_cast<colored_graph::EdgeId>(below(static_cast<int>(graph.edgeIdEnd())));
      if (graph.containsEdge(e)) return e;
    }
  }

  colored_graph::ColoredGraph graph{kClasses};

 private:
  struct Point {
    double x, y;
  };
  static constexpr double kSpacing = 0.0013;  // m

  double meters(colored_graph::VertexId a, colored_graph::VertexId b) const {
    return std::hypot(m_points[a].x - m_points[b].x, m_points[a].y - m_points[b].y);
  }

  std::mt19937 m_random;
  int m_cells;
  std::vector<Point> m_points;
};

/** A whole graph at once. */
inline PlaneGraph randomPlaneGraph(unsigned seed, int vertices, int edges, int cells,
                                   double reach = 1e9) {
  PlaneGraph plane(seed, cells);
  for (int i = 0; i < vertices; ++i) plane.addVertex();
  for (int i = 0; i < edges; ++i) plane.addEdge(reach);
  return plane;
}

/** All edge models and cost kinds with this order, without and with tolls. */
inline std::vector<colored_graph::CostModel> allModels(const colored_graph::ClassOrder& order) {
  using namespace colored_graph;
  std::vector<CostModel> models;
  for (const EdgeModel edges : {EdgeModel::Endpoint, EdgeModel::Sweep, EdgeModel::Profile})
    for (const CostKind kind : {CostKind::Count, CostKind::ArcLength})
      for (const bool tolls : {false, true}) models.push_back({order, edges, kind, tolls});
  return models;
}

/** With the plane's bound of lengths. */
inline colored_graph::SearchOptions boundedBy(const PlaneGraph& plane) {
  colored_graph::SearchOptions options;
  options.lengthBound = [&plane](colored_graph::VertexId a, colored_graph::VertexId b) {
    return plane.bound(a, b);
  };
  return options;
}
