#pragma once
#include <colored_graph/ColoredAStar.h>
#include <colored_graph/CostModel.h>
#include <semantic_planning/roadmap/Roadmap.h>

#include "Trial.h"

namespace planning_study {

/** What is searched: a roadmap in which no edge is evaluated. */
struct RoadmapTask {
  const semantic_planning::Roadmap& roadmap;
  colored_graph::VertexId start, goal;
  const colored_graph::ClassOrder& order;
  colored_graph::CostKind cost;
};

/** Trial::judgment of one number for all classes: rank k weighs 10^k. */
extern const char* const kWeighted;

/** Both search a copy and put the outcome and the times into the trial. */
void searchColored(const RoadmapTask& task, colored_graph::EdgeModel model, Trial& trial);
/** Ordinary A*, by the same code with a single class: an edge costs the sum of 10^rank * length. */
void searchWeighted(const RoadmapTask& task, Trial& trial);

/** Sum of 10^rank * length; nothing if a class is forbidden. */
std::optional<Length> weighted(const colored_graph::EdgeProfile& profile,
                               const colored_graph::ClassOrder& order);

}  // namespace planning_study
