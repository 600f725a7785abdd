#pragma once
#include <colored_graph/ColoredAStar.h>
#include <colored_graph/ColoredGraph.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

/** \file What a search does with a graph, whatever its costs are. */

namespace colored_graph {

/** Vertices by key, smallest first, each at most once; equal keys in the order of their ids. A
 * binary heap that knows where each vertex stands, so that its key can be changed. */
template <class Key>
class VertexHeap {
 public:
  struct Entry {
    Key key;
    VertexId vertex;
    bool operator<(const Entry& o) const { return key == o.key ? vertex < o.vertex : key < o.key; }
  };

  bool empty() const { return m_entries.empty(); }
  const Entry& top() const { return m_entries.front(); }

  void reset(std::size_t vertices) {
    m_entries.clear();
    m_places.assign(vertices, kAbsent);
  }
  void growTo(std::size_t vertices) {
    if (vertices > m_places.size()) m_places.resize(vertices, kAbsent);
  }

  /** Inserts the vertex or changes its key. */
  void set(VertexId v, const Key& key) {
    std::size_t place = m_places[v];
    if (place == kAbsent) {
      place = m_entries.size();
      m_entries.push_back({key, v});
    }
    m_entries[place].key = key;
    settle(place);
  }

  void remove(VertexId v) {
    const std::size_t place = m_places[v];
    if (place == kAbsent) return;
    m_places[v] = kAbsent;
    const Entry last = m_entries.back();
    m_entries.pop_back();
    if (place == m_entries.size()) return;
    m_entries[place] = last;
    settle(place);
  }

  /** Asks keyOf(vertex) for every key again. */
  template <class KeyOf>
  void rekey(KeyOf keyOf) {
    for (Entry& entry : m_entries) entry.key = keyOf(entry.vertex);
    for (std::size_t place = m_entries.size(); place-- > 0;) sink(place);
  }

 private:
  static constexpr std::size_t kAbsent = ~std::size_t{0};

  void settle(std::size_t place) { sink(rise(place)); }

  std::size_t rise(std::size_t place) {
    const Entry entry = m_entries[place];
    while (place > 0 && entry < m_entries[(place - 1) / 2]) {
      put(place, m_entries[(place - 1) / 2]);
      place = (place - 1) / 2;
    }
    put(place, entry);
    return place;
  }

  void sink(std::size_t place) {
    const Entry entry = m_entries[place];
    for (std::size_t child; (child = 2 * place + 1) < m_entries.size(); place = child) {
      if (child + 1 < m_entries.size() && m_entries[child + 1] < m_entries[child]) ++child;
      if (!(m_entries[child] < entry)) break;
      put(place, m_entries[child]);
    }
    put(place, entry);
  }

  void put(std::size_t place, const Entry& entry) {
    m_entries[place] = entry;
    m_places[entry.vertex] = place;
  }

  std::vector<Entry> m_entries;
  std::vector<std::size_t> m_places;
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
