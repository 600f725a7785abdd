#include <benchmark/benchmark.h>
#include <colored_graph/ColoredAStar.h>
#include <colored_graph/ColoredReplanner.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "Oracles.h"

// Searches per second on random geometric graphs: n points in a square of 100 m, each joined to its
// 10 nearest, four classes in patches of about 15 m.
namespace {

using namespace colored_graph;

constexpr int kNeighbors = 10;
constexpr int kClasses = 16;  // of which four occur

struct Point {
  double x, y;
};

double distance(Point a, Point b) { return std::hypot(a.x - b.x, a.y - b.y); }

GraphClass patchAt(Point p) {
  const double field = std::sin(p.x / 7) + std::sin(p.y / 5) + std::sin((p.x + p.y) / 9);
  return static_cast<GraphClass>(std::clamp(static_cast<int>(std::floor(field + 2)), 0, 3));
}

class Town {
 public:
  explicit Town(int vertices) : m_random(1) {
    std::uniform_real_distribution<double> coordinate(0, 100);
    for (int i = 0; i < vertices; ++i) {
      points.push_back({coordinate(m_random), coordinate(m_random)});
      graph.addVertex(patchAt(points.back()));
    }
    for (VertexId v = 0; v < points.size(); ++v) joinToNearest(v);
    options.lengthBound = [this](VertexId a, VertexId b) {
      return lengthDown(distance(points[a], points[b]));
    };
  }
  Town(const Town&) = delete;

  /** Ends of a search that can succeed, at least 50 m apart. */
  std::pair<VertexId, VertexId> ends() {
    for (;;) {
      const VertexId a = m_random() % points.size(), b = m_random() % points.size();
      if (distance(points[a], points[b]) >= 50) return {a, b};
    }
  }

  /** Gives 1 % of the edges the class of their patch or any class: scattered, or those around one
   * point, as a new scan does. */
  void recolor(bool scattered) {
    const std::size_t count = graph.edgeCount() / 100;
    if (scattered) {
      for (std::size_t i = 0; i < count; ++i) recolorEdge(m_random() % graph.edgeIdEnd());
      return;
    }
    const Point center = points[m_random() % points.size()];
    std::vector<std::pair<double, EdgeId>> near;
    for (EdgeId e = 0; e < graph.edgeIdEnd(); ++e) near.push_back({distance(middle(e), center), e});
    std::nth_element(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
    for (std::size_t i = 0; i < count; ++i) recolorEdge(near[i].second);
  }

  CostModel model(int ranks) const {
    std::vector<std::vector<GraphClass>> order;
    for (int r = 0; r < ranks; ++r) order.push_back({static_cast<GraphClass>(r)});
    return {ClassOrder(kClasses, order), EdgeModel::Sweep, CostKind::ArcLength};
  }

  ColoredGraph graph{kClasses};
  std::vector<Point> points;
  SearchOptions options;

 private:
  void joinToNearest(VertexId v) {
    std::vector<std::pair<double, VertexId>> near;
    for (VertexId w = 0; w < points.size(); ++w)
      near.push_back({distance(points[v], points[w]), w});
    std::partial_sort(near.begin(), near.begin() + kNeighbors + 1, near.end());
    for (int i = 1; i <= kNeighbors; ++i) join(v, near[i].second);
  }

  void join(VertexId v, VertexId w) {
    for (const Incidence& i : graph.incident(v))
      if (i.neighbor == w) return;
    const Point middle{(points[v].x + points[w].x) / 2, (points[v].y + points[w].y) / 2};
    graph.addEdge(v, w, {{patchAt(middle), lengthUp(distance(points[v], points[w]))}});
  }

  Point middle(EdgeId e) const {
    const Point a = points[graph.edge(e).a], b = points[graph.edge(e).b];
    return {(a.x + b.x) / 2, (a.y + b.y) / 2};
  }

  void recolorEdge(EdgeId e) {
    const bool back = m_random() % 2;
    const GraphClass id = back ? patchAt(middle(e)) : static_cast<GraphClass>(m_random() % 4);
    graph.setProfile(e, {{id, graph.edge(e).length}});
  }

  std::mt19937 m_random;
};

void report(benchmark::State& state, std::size_t expansions) {
  state.SetItemsProcessed(state.iterations());
  state.counters["expansions"] =
      benchmark::Counter(static_cast<double>(expansions), benchmark::Counter::kAvgIterations);
}

void search(benchmark::State& state, int ranks, bool bounded) {
  Town town(static_cast<int>(state.range(0)));
  const CostModel model = town.model(ranks);
  SearchOptions options = town.options;
  if (!bounded) options.lengthBound = nullptr;
  std::size_t expansions = 0;
  for (auto _ : state) {
    const auto [start, goal] = town.ends();
    const PathResult result = findColoredPath(town.graph, start, goal, model, options);
    if (!result.found()) state.SkipWithError(describe(result.status));
    expansions += result.statistics.expansions;
  }
  report(state, expansions);
}

/** std::set of std::vectors, as in the tests. */
void textbookDijkstra(benchmark::State& state) {
  Town town(static_cast<int>(state.range(0)));
  const CostModel model = town.model(4);
  for (auto _ : state) {
    const auto [start, goal] = town.ends();
    benchmark::DoNotOptimize(oracles::tupleDijkstra(town.graph, model, start, goal));
  }
  report(state, 0);
}

/** After 1 % of the edges got another class: the search from scratch, or the repair. */
void afterRecoloring(benchmark::State& state, bool scattered, bool incremental) {
  Town town(static_cast<int>(state.range(0)));
  const CostModel model = town.model(4);
  const auto [start, goal] = town.ends();
  ColoredReplanner replanner(town.graph, start, goal, model, town.options);
  replanner.solve();
  std::size_t expansions = 0;
  for (auto _ : state) {
    state.PauseTiming();
    town.recolor(scattered);
    state.ResumeTiming();
    expansions += (incremental ? replanner.solve()
                               : findColoredPath(town.graph, start, goal, model, town.options))
                      .statistics.expansions;
  }
  report(state, expansions);
}

void sizes(benchmark::internal::Benchmark* b) {
  b->Arg(1000)->Arg(10000)->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(search, coaStar, 4, true)->Apply(sizes);
BENCHMARK_CAPTURE(search, coaStarVectorsFor8Ranks, 8, true)->Apply(sizes);
BENCHMARK_CAPTURE(search, coaStarVectorsFor16Ranks, 16, true)->Apply(sizes);
BENCHMARK_CAPTURE(search, dijkstraWithTheSameQueue, 4, false)->Apply(sizes);
BENCHMARK(textbookDijkstra)->Apply(sizes);
BENCHMARK_CAPTURE(afterRecoloring, scatteredScratch, true, false)->Apply(sizes);
BENCHMARK_CAPTURE(afterRecoloring, scatteredIncremental, true, true)->Apply(sizes);
BENCHMARK_CAPTURE(afterRecoloring, localScratch, false, false)->Apply(sizes);
BENCHMARK_CAPTURE(afterRecoloring, localIncremental, false, true)->Apply(sizes);

}  // namespace
