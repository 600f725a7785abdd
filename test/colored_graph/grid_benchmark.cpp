#include <benchmark/benchmark.h>
#include <colored_graph/ColoredAStar.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <random>
#include <utility>
#include <vector>

// Grids of 512 x 512 cells, 8 neighbors, as in benchmarks of path finding: walls, and four classes
// in patches. COA* beside a plain Dijkstra whose costs and labels are tuples packed into 128 bits.
namespace {

using namespace colored_graph;
__extension__ typedef unsigned __int128 Packed;

constexpr int kSide = 512;

/** A graph as the plain search likes it. */
struct Rows {
  std::vector<std::size_t> first{0};  // of each vertex, and the end
  std::vector<VertexId> to;
  std::vector<Packed> cost;
};

class Grid {
 public:
  explicit Grid(bool classes) {
    for (int i = 0; i < kSide * kSide; ++i)
      m_ids.push_back(isWall(i) ? kNoVertex : graph.addVertex(classes ? classAt(i) : 0));
    for (int i = 0; i < kSide * kSide; ++i)
      if (m_ids[i] != kNoVertex) m_cells.push_back(i);
    for (const int i : m_cells) join(i);
    options.lengthBound = [this](VertexId a, VertexId b) { return straight(a, b); };
  }
  Grid(const Grid&) = delete;

  std::pair<VertexId, VertexId> ends() {
    for (;;) {
      const VertexId a = m_random() % m_cells.size(), b = m_random() % m_cells.size();
      if (straight(a, b) > 1500000) return {a, b};
    }
  }
  Rows rows() const {
    Rows rows;
    for (VertexId v = 0; v < graph.vertexIdEnd(); ++v) {
      for (const Incidence& i : graph.incident(v)) {
        const Edge edge = graph.edge(i.edge);
        const auto length = static_cast<Packed>(edge.length);
        const int rank = edge.profile[0].classId;
        rows.to.push_back(i.neighbor);
        rows.cost.push_back((rank ? length << (20 + 27 * rank) : 0) | length << 20 | 1);
      }
      rows.first.push_back(rows.to.size());
    }
    return rows;
  }

  ColoredGraph graph{8};
  ColoredAStarOptions options;
  const CostModel model{ClassOrder(8, {{0}, {1}, {2}, {3}}), EdgeModel::Profile};

 private:
  Length straight(VertexId a, VertexId b) const {
    const Length dx = std::abs(m_cells[a] % kSide - m_cells[b] % kSide);
    const Length dy = std::abs(m_cells[a] / kSide - m_cells[b] / kSide);
    return 10000 * std::max(dx, dy) + 4142 * std::min(dx, dy);
  }
  static double field(int i, double scale) {
    const double x = i % kSide / scale, y = i / kSide / scale;
    return std::sin(x) + std::sin(1.3 * y + 1) + std::sin(0.7 * (x + y)) + std::sin(1.9 * x - y);
  }
  static bool isWall(int i) { return field(i, 17) > 1.2; }
  static GraphClass classAt(int i) {
    return static_cast<GraphClass>(std::clamp(static_cast<int>(field(i, 7) + 2), 0, 3));
  }
  bool isFree(int x, int y) const {
    return x >= 0 && x < kSide && y < kSide && m_ids[y * kSide + x] != kNoVertex;
  }
  void join(int i) {
    const int x = i % kSide, y = i / kSide;
    for (const auto& [dx, dy] :
         {std::pair(1, 0), std::pair(0, 1), std::pair(1, 1), std::pair(-1, 1)})
      if (isFree(x + dx, y + dy) && isFree(x + dx, y) && isFree(x, y + dy)) {
        const VertexId a = m_ids[i], b = m_ids[i + dy * kSide + dx];
        const GraphClass worse = std::max(graph.vertexClass(a), graph.vertexClass(b));
        graph.addEdge(a, b, {{worse, dx && dy ? 14143 : 10000}});
      }
  }

  std::vector<VertexId> m_ids;
  std::vector<int> m_cells;
  std::mt19937 m_random{1};
};

Packed plainDijkstra(const Rows& rows, VertexId start, VertexId goal) {
  std::vector<Packed> best(rows.first.size() - 1, std::numeric_limits<Packed>::max());
  using Entry = std::pair<Packed, VertexId>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  queue.push({best[start] = 0, start});
  while (!queue.empty() && queue.top().second != goal) {
    const auto [cost, v] = queue.top();
    queue.pop();
    if (cost != best[v]) continue;
    for (std::size_t i = rows.first[v]; i < rows.first[v + 1]; ++i)
      if (Packed& known = best[rows.to[i]]; cost + rows.cost[i] < known)
        queue.push({known = cost + rows.cost[i], rows.to[i]});
  }
  return best[goal];
}

void coaStar(benchmark::State& state, bool classes, bool bounded) {
  Grid grid(classes);
  if (!bounded) grid.options.lengthBound = nullptr;
  std::size_t expansions = 0;
  for (auto _ : state) {
    const auto [start, goal] = grid.ends();
    expansions +=
        findColoredPath(grid.graph, start, goal, grid.model, grid.options).statistics.expansions;
  }
  state.counters["expansions"] =
      benchmark::Counter(static_cast<double>(expansions), benchmark::Counter::kAvgIterations);
}

void plain(benchmark::State& state, bool classes) {
  Grid grid(classes);
  const Rows rows = grid.rows();
  for (auto _ : state) {
    const auto [start, goal] = grid.ends();
    benchmark::DoNotOptimize(plainDijkstra(rows, goal, start));
  }
}

BENCHMARK_CAPTURE(plain, fourClasses, true)->Unit(benchmark::kMillisecond)->Iterations(20);
BENCHMARK_CAPTURE(coaStar, fourClasses, true, true)->Unit(benchmark::kMillisecond)->Iterations(20);
BENCHMARK_CAPTURE(coaStar, fourClassesUnbounded, true, false)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(20);
BENCHMARK_CAPTURE(plain, oneClass, false)->Unit(benchmark::kMillisecond)->Iterations(20);
BENCHMARK_CAPTURE(coaStar, oneClass, false, true)->Unit(benchmark::kMillisecond)->Iterations(20);

}  // namespace
