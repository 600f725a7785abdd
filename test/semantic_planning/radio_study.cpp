// What a path costs that is planned on so many kilobytes of a map: the stream of semantic-map-send,
// OctoMap's binary tree cut at several depths, and the leaves of the same tree in random order.
//
//     radio_study MAP ORDER WEIGHTS SOLUTION FOLDER [TASKS]
//
// writes radio.csv and radio.png. A path leads over columns of the map. A meter in a column costs
// 1, 2, 4, ... for the ranks of the order, 64 where it is forbidden, as the classes of the cells
// are expected there: of the ground's voxel, and of occupied ones up to 1.2 m above it. Where the
// ground is is known; what it is, and what stands on it, is what is asked of the map. What a path
// costs in the end, the whole map says.
#include <map_operations/MapOperations.h>
#include <map_streams/MapStream.h>
#include <octomap/OcTree.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/TreeFile.h>
#include <semantic_planning/planner/OrderFile.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <queue>
#include <random>
#include <sstream>

#include "StreamTree.h"
#include "figures/FigureScript.h"

namespace {

using namespace semantic_planning;
using semantic_octree::Abstraction;
using semantic_octree::SemanticOcTree;

using Column = std::size_t;

/** Of the paths that one map leads to. */
struct Outcome {
  std::string method;
  double kilobytes = 0;
  double cost = 0;  ///< mean, of the whole map's paths 1
};

constexpr double kForbiddenCost = 64;

/** The columns of a square around the middle of the map, and where their ground is. */
class Field {
 public:
  Field(const SemanticOcTree& map, const colored_graph::ClassOrder& order)
      : m_ground(std::size_t(kEdge) * kEdge) {
    double low[3], high[3];
    map.getMetricMin(low[0], low[1], low[2]);
    map.getMetricMax(high[0], high[1], high[2]);
    for (int axis = 0; axis < 2; ++axis)
      m_first[axis] =
          semantic_octree::keyOf((low[axis] + high[axis]) / 2, map.getResolution()) - kEdge / 2;
    for (Column c = 0; c < m_ground.size(); ++c) m_ground[c] = groundIn(map, c);
    m_truth = costs(map, order);
  }

  /** Per column, a meter's cost as a map has it. \param order of the map's classes */
  std::vector<double> costs(const SemanticOcTree& map,
                            const colored_graph::ClassOrder& order) const {
    std::vector<double> costs(m_ground.size(), kForbiddenCost);
    for (Column c = 0; c < costs.size(); ++c) {
      if (m_ground[c] == 0) continue;
      const auto ground = map.search(keyOf(c, m_ground[c]));
      const bool isKnown = ground && map.isNodeOccupied(ground);
      costs[c] = isKnown ? expected(map, ground, order) : costOf(order.rank(0));
      for (int z = m_ground[c] + 2; z <= m_ground[c] + 6; ++z) {
        const auto above = map.search(keyOf(c, z));
        if (above && map.isNodeOccupied(above))
          costs[c] =
              std::max(costs[c], order.ranks() == 1 ? kForbiddenCost : expected(map, above, order));
      }
    }
    return costs;
  }
  /** Pairs of columns on the best classes, far apart. */
  std::vector<std::pair<Column, Column>> tasks(std::size_t number) const {
    std::mt19937 random(1);
    std::vector<Column> places;
    for (Column c = 0; c < m_truth.size(); ++c)
      if (m_truth[c] < 1.2) places.push_back(c);
    if (places.size() < 1000) throw std::runtime_error("too few columns of the best classes");
    const auto place = [&] { return places[random() % places.size()]; };
    std::vector<std::pair<Column, Column>> tasks;
    while (tasks.size() < number) {
      const Column a = place(), b = place();
      const int dx = int(a % kEdge) - int(b % kEdge), dy = int(a / kEdge) - int(b / kEdge);
      if (std::hypot(dx, dy) > kEdge / 3.0) tasks.emplace_back(a, b);
    }
    return tasks;
  }
  /** True cost of the path that is best by these costs (Dijkstra, eight neighbors). */
  double pathCost(const std::vector<double>& costs, Column from, Column to) const {
    std::vector<double> reached(costs.size(), INFINITY), truth(costs.size(), 0);
    std::priority_queue<std::pair<double, Column>> open;
    reached[from] = 0;
    open.emplace(0, from);
    while (!open.empty()) {
      const auto [negative, c] = open.top();
      open.pop();
      if (c == to) break;
      if (-negative > reached[c]) continue;
      for (int i = 0; i < 9; ++i) {
        const int x = int(c % kEdge) + i % 3 - 1, y = int(c / kEdge) + i / 3 - 1;
        if (i == 4 || x < 0 || y < 0 || x >= kEdge || y >= kEdge) continue;
        const Column next = Column(y) * kEdge + Column(x);
        const double step = i % 2 ? 1 : std::sqrt(2.0);
        const double cost = reached[c] + step * 0.5 * (costs[c] + costs[next]);
        if (cost >= reached[next]) continue;
        reached[next] = cost;
        truth[next] = truth[c] + step * 0.5 * (m_truth[c] + m_truth[next]);
        open.emplace(-cost, next);
      }
    }
    return truth[to];
  }

 private:
  static constexpr int kEdge = 360, kBelow = 20, kAbove = 20;  // columns, voxels

  octomap::OcTreeKey keyOf(Column c, int z) const {
    return semantic_octree::octomapKey(m_first[0] + int(c % kEdge), m_first[1] + int(c / kEdge), z);
  }
  static double costOf(colored_graph::Rank rank) {
    return rank == colored_graph::kForbidden ? kForbiddenCost : std::ldexp(1.0, rank);
  }
  /** Key of the lowest occupied voxel; 0: none. */
  int groundIn(const SemanticOcTree& map, Column c) const {
    using semantic_octree::kKeyOfOrigin;
    for (int z = kKeyOfOrigin - kBelow; z < kKeyOfOrigin + kAbove; ++z)
      if (const auto node = map.search(keyOf(c, z)); node && map.isNodeOccupied(node)) return z;
    return 0;
  }
  static double expected(const SemanticOcTree& map, const semantic_octree::SemanticOcTreeNode& node,
                         const colored_graph::ClassOrder& order) {
    if (!node.hasClassRecord()) return costOf(order.rank(0));
    const std::vector<double> p = map.distribution(node);
    double sum = 0;
    for (std::size_t k = 1; k < p.size(); ++k)
      sum += p[k] * costOf(order.rank(static_cast<colored_graph::GraphClass>(k)));
    return sum / (1 - p[0]);
  }

  int m_first[2];  ///< lowest keys
  std::vector<int> m_ground;
  std::vector<double> m_truth;
};

class Study {
 public:
  Study(const std::string& map, const std::string& order, const std::string& weights,
        const std::string& solution, std::size_t tasks)
      : m_map(semantic_octree::loadTree(map)),
        m_options(abstractionOf(weights, solution, m_map.classes())),
        m_order(loadClassOrder(order, m_map.classes())),
        m_field(m_map, m_order),
        m_tasks(m_field.tasks(tasks)) {
    const std::vector<double> truth = m_field.costs(m_map, m_order);
    for (const auto& [from, to] : m_tasks) m_best.push_back(m_field.pathCost(truth, from, to));
  }

  std::vector<Outcome> run() {
    add("whole map", static_cast<double>(fileBytes(m_map)), m_map, m_order);
    stream();
    octomap();
    return std::move(m_outcomes);
  }

 private:
  static std::size_t fileBytes(const SemanticOcTree& map) {
    std::ostringstream out;
    writeTree(out, map);
    return out.str().size();
  }
  void add(const std::string& method, double bytes, const SemanticOcTree& map,
           const colored_graph::ClassOrder& order) {
    Outcome outcome{method, bytes / 1000, 0};
    const std::vector<double> costs = m_field.costs(map, order);
    for (std::size_t i = 0; i < m_tasks.size(); ++i)
      outcome.cost += m_field.pathCost(costs, m_tasks[i].first, m_tasks[i].second) / m_best[i] /
                      static_cast<double>(m_tasks.size());
    std::cout << method << ": " << outcome.kilobytes << " kB, cost " << outcome.cost << std::endl;
    m_outcomes.push_back(outcome);
  }

  /** Ours, and the same leaves in random order at the same number of bytes a leaf. */
  void stream() {
    SemanticOcTree map = m_map;
    m_options.weights.alpha = 0;
    setAbstraction(map, m_options);
    semantic_octree::MapSender sender(1);
    sender.setMap(map);
    semantic_octree::MapReceiver receiver(1);
    const auto& prefixes = sender.prefixes();
    std::vector<semantic_octree::LeafCell> leaves = Abstraction(map).leaves();
    std::shuffle(leaves.begin(), leaves.end(), std::mt19937(1));
    const double bytesPerLeaf =
        static_cast<double>(prefixes.back().bytes) / static_cast<double>(leaves.size());
    double wanted = 8e3;
    for (const auto& prefix : prefixes) {
      receiver.accept(*sender.next());
      const auto bytes = static_cast<double>(prefix.bytes);
      if (bytes < wanted && prefix.packets != prefixes.size()) continue;
      wanted *= 2;
      SemanticOcTree known = receiver.map();
      add("semantic-map-send", bytes, known, m_order);
      SemanticOcTree some = randomPart(map, leaves, bytes / bytesPerLeaf);
      add("leaves in random order", bytes, some, m_order);
    }
  }

  SemanticOcTree randomPart(const SemanticOcTree& map,
                            const std::vector<semantic_octree::LeafCell>& leaves, double number) {
    using namespace semantic_octree;
    StreamTree tree;
    for (std::size_t i = 0; i < leaves.size() && static_cast<double>(i) < number; ++i) {
      TreePart part;
      part.cell = CellPath::of(leaves[i]);
      part.leaves[0] = StreamLeaf::of(contentOf(leaves[i].node, map.numClasses()));
      tree.apply(part, 0);
    }
    return tree.map(SemanticOcTree(map.getResolution(), map.classes(), map.filterParameters()));
  }

  /** Cut at a depth, coarse first, as its stream would be; all that it tells is one class. */
  void octomap() {
    semantic_octree::ClassTable classes;
    classes.add("occupied", {});
    const colored_graph::ClassOrder order(2, {{0, 1}});  // one rank: nothing is known of classes
    for (int levels = 5; levels >= 0; --levels) {
      const auto tree = toOcTree(coarsened(m_map, levels));
      std::ostringstream out;
      tree->writeBinaryConst(out);
      std::istringstream in(out.str());
      ::octomap::OcTree read(1);
      read.readBinary(in);
      SemanticOcTree known = semantic_octree::fromOcTree(read, classes);
      add("OctoMap .bt", static_cast<double>(out.str().size()), known, order);
    }
  }

  SemanticOcTree m_map;
  semantic_octree::AbstractionOptions m_options;
  colored_graph::ClassOrder m_order;
  Field m_field;
  std::vector<std::pair<Column, Column>> m_tasks;
  std::vector<double> m_best;  ///< cost of each
  std::vector<Outcome> m_outcomes;
};

void draw(const std::vector<Outcome>& outcomes, const std::filesystem::path& file) {
  auto out = figures::scriptFor(900, 460);
  const std::vector<std::string> methods = {"semantic-map-send", "OctoMap .bt",
                                            "leaves in random order", "whole map"};
  for (std::size_t m = 0; m < methods.size(); ++m) {
    out << "$m" << m << " << EOD\n";
    for (const Outcome& o : outcomes)
      if (o.method == methods[m]) out << o.kilobytes << ' ' << o.cost << '\n';
    out << "EOD\n";
  }
  out << "set logscale xy\nset xlabel 'kilobytes that came'\nset ylabel 'cost of the path, with "
         "the whole map 1'\n"
         "set yrange [0.95:]\nset ytics (1, 1.5, 2, 3, 4, 5, 7, 10)\nset grid\nset key samplen 5\n"
         "plot ";
  for (std::size_t m = 0; m < methods.size(); ++m)
    out << "$m" << m << " with linespoints lw 2 ps 1.3 " << figures::styleOf(m) << " title "
        << figures::gnuplotText(methods[m]) << ", ";
  out << "NaN notitle\n";
  figures::drawWithGnuplot(out.str(), file);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 6) {
    std::cerr << "radio_study MAP ORDER WEIGHTS SOLUTION FOLDER [TASKS]\n";
    return 64;
  }
  const std::filesystem::path folder = argv[5];
  std::filesystem::create_directories(folder);
  const auto outcomes =
      Study(argv[1], argv[2], argv[3], argv[4], argc > 6 ? std::stoul(argv[6]) : 10).run();
  std::ofstream csv(folder / "radio.csv");
  csv << "method,kilobytes,cost\n";
  for (const Outcome& o : outcomes) csv << o.method << ',' << o.kilobytes << ',' << o.cost << '\n';
  draw(outcomes, folder / "radio.png");
  return 0;
}
