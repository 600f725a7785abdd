#include <colored_graph/ColoredReplanner.h>

#include "LifelongSearch.h"

namespace colored_graph {

class ColoredReplanner::Impl {
 public:
  virtual ~Impl() = default;
  virtual PathResult solve() = 0;
  virtual void moveStart(VertexId start) = 0;
};

template <int N>
class ColoredReplanner::Search : public Impl {
 public:
  Search(ColoredGraph& graph, VertexId start, VertexId goal, const CostModel& model,
         const SearchOptions& options)
      : m_search(graph, start, goal, model, options) {}
  PathResult solve() override { return m_search.solve(); }
  void moveStart(VertexId start) override { m_search.moveStart(start); }

 private:
  LifelongSearch<N> m_search;
};

ColoredReplanner::ColoredReplanner(ColoredGraph& graph, VertexId start, VertexId goal,
                                   const CostModel& model, const SearchOptions& options) {
  model.validate(graph);
  m_impl = withVectorSize(model, [&](auto size) -> std::unique_ptr<Impl> {
    return std::make_unique<Search<size()>>(graph, start, goal, model, options);
  });
}

ColoredReplanner::~ColoredReplanner() = default;
ColoredReplanner::ColoredReplanner(ColoredReplanner&&) noexcept = default;
ColoredReplanner& ColoredReplanner::operator=(ColoredReplanner&&) noexcept = default;

PathResult ColoredReplanner::solve() { return m_impl->solve(); }

void ColoredReplanner::moveStart(VertexId start) { m_impl->moveStart(start); }

}  // namespace colored_graph
