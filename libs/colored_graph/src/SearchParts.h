#pragma once
#include <colored_graph/ColoredAStar.h>
#include <colored_graph/ColoredGraph.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <utility>
#include <vector>

/** \file What a search does with a graph, whatever its costs are. */

namespace colored_graph {

/** Vertices by key, smallest first, each at most once; equal keys in the order of their ids. */
template <class Key>
class VertexQueue {
 public:
  struct Entry {
    Key key;
    VertexId vertex;
    bool operator<(const Entry& o) const { return key == o.key ? vertex < o.vertex : key < o.key; }
  };

  bool empty() const { return m_entries.empty(); }
  const Entry& top() const { return *m_entries.begin(); }

  void reset(std::size_t vertices) {
    m_entries.clear();
    m_keys.assign(vertices, std::nullopt);
  }
  void growTo(std::size_t vertices) { m_keys.resize(vertices); }

  /** Inserts the vertex or changes its key. */
  void set(VertexId v, const Key& key) {
    remove(v);
    m_keys[v] = key;
    m_entries.insert({key, v});
  }
  void remove(VertexId v) {
    if (m_keys[v]) m_entries.erase({*m_keys[v], v});
    m_keys[v].reset();
  }

  /** Asks keyOf(vertex) for every key again. */
  template <class KeyOf>
  void rekey(KeyOf keyOf) {
    for (const Entry& entry : std::exchange(m_entries, {})) {
      m_keys[entry.vertex].reset();
      set(entry.vertex, keyOf(entry.vertex));
    }
  }

 private:
  std::set<Entry> m_entries;
  std::vector<std::optional<Key>> m_keys;  ///< by vertex; none: absent
};

/** Whether a search should stop. */
class StopCheck {
 public:
  explicit StopCheck(const SearchOptions& options) : m_options(options) {}

  /** Before something that may take long. */
  std::optional<SearchStatus> now() const {
    if (m_options.cancelled && m_options.cancelled()) return SearchStatus::Cancelled;
    return std::nullopt;
  }

  /** In a loop whose turns are short: looks in the first turn and then in every 32nd. */
  std::optional<SearchStatus> inLoop() { return m_turns++ % 32 == 0 ? now() : std::nullopt; }

 private:
  const SearchOptions& m_options;
  unsigned m_turns = 0;
};

/** StartNotInGraph or GoalNotInGraph, if so. */
std::optional<SearchStatus> missingEnd(const ColoredGraph& graph, VertexId start, VertexId goal);

/** A result with status, vertices, edges and lengths per class: the path that leaves start along
 * `edges`. */
PathResult assemblePath(const ColoredGraph& graph, VertexId start, std::vector<EdgeId> edges);

/** Why there is no path, given whether the cost model lets a vertex be left along an edge. */
SearchStatus diagnose(const ColoredGraph& graph, VertexId start, VertexId goal,
                      const std::function<bool(const Incidence&)>& allowed);

/** Evaluates an edge and lets the graph keep the answer.
 * \throw std::invalid_argument no function given. */
void evaluateEdge(ColoredGraph& graph, EdgeId e,
                  const std::function<std::optional<EdgeProfile>(EdgeId)>& evaluate);

}  // namespace colored_graph
