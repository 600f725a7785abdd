#include <semantic_planning/roadmap/RoadmapOptions.h>

namespace semantic_planning {

using strict_files::atLeast;
using strict_files::Choices;

const Choices<GraphKind>& choicesOf(GraphKind) {
  static const Choices<GraphKind> choices = {{"compressed", GraphKind::Compressed},
                                             {"leaves", GraphKind::Leaves},
                                             {"halton", GraphKind::Halton},
                                             {"halton_drivable", GraphKind::HaltonDrivable},
                                             {"full", GraphKind::Full}};
  return choices;
}

const char* nameOf(GraphKind kind) { return strict_files::nameIn(choicesOf(kind), kind); }

bool isOfTree(GraphKind kind) { return kind == GraphKind::Compressed || kind == GraphKind::Leaves; }

void RoadmapOptions::describe(strict_files::OptionList& list) {
  strict_files::Range buffers = atLeast(0);
  buffers.withInfinity = true;
  list.add("graph", kind, "", "where the graph's vertices come from");
  list.add("vertices", vertices, "",
           "how many; more: better paths, more time; of halton, draws; 0: all that the map offers");
  list.add("buffer", buffer, "m", buffers, "vertices lie this near to the line from start to goal");
}

void RoadmapOptions::validate() const { strict_files::checkOptions(*this, "RoadmapOptions"); }

const Choices<ClassReading::Kind>& choicesOf(ClassReading::Kind) {
  using Kind = ClassReading::Kind;
  static const Choices<Kind> choices = {
      {"likeliest", Kind::Likeliest}, {"expected", Kind::Expected}, {"cautious", Kind::Cautious}};
  return choices;
}

}  // namespace semantic_planning
