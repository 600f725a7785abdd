#include <semantic_planning/roadmap/RoadmapOptions.h>

#include <strict_files/OptionChecks.h>

namespace semantic_planning {

const char* nameOf(GraphKind kind) {
  static const char* const names[] = {"compressed",      "halton",     "halton_drivable",
                                      "halton_by_class", "halton_map", "full"};
  return names[static_cast<int>(kind)];
}

bool belongsToMap(GraphKind kind) {
  return kind == GraphKind::Compressed || kind == GraphKind::HaltonMap || kind == GraphKind::Full;
}

std::map<std::string, GraphKind> graphKinds() {
  std::map<std::string, GraphKind> kinds;
  for (const GraphKind kind : {GraphKind::Compressed, GraphKind::Halton, GraphKind::HaltonDrivable,
                               GraphKind::HaltonByClass, GraphKind::HaltonMap, GraphKind::Full})
    kinds[nameOf(kind)] = kind;
  return kinds;
}

void RoadmapOptions::validate() const {
  const strict_files::OptionChecks check("RoadmapOptions");
  check.within("neighbors", neighbors, 1, 1000);
  check.positive("longestEdge", longestEdge);
  check.within("headings", headings, 1, 360);
  check.positive("spacing", spacing);
  if (!(buffer >= 0)) check.notNegative("buffer", buffer);
}

}  // namespace semantic_planning
