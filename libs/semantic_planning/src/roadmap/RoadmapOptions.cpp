#include <semantic_planning/roadmap/RoadmapOptions.h>

namespace semantic_planning {

using strict_files::atLeast;
using strict_files::between;
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
  list.add("headings", headings, "", between(1, 360), "at each point (compressed, leaves, full)");
  list.add(
      "align_headings", alignHeadings, "",
      "headings follow roads and free space; false: they look random (compressed, leaves, full)");
  list.add("buffer", buffer, "m", buffers, "vertices lie this near to the line from start to goal");
}

void RoadmapOptions::validate() const { strict_files::checkOptions(*this, "RoadmapOptions"); }

const Choices<ClassReading::Kind>& choicesOf(ClassReading::Kind) {
  using Kind = ClassReading::Kind;
  static const Choices<Kind> choices = {
      {"likeliest", Kind::Likeliest}, {"expected", Kind::Expected}, {"cautious", Kind::Cautious}};
  return choices;
}

void ClassReading::describe(strict_files::OptionList& list) {
  list.add("reading", kind, "", "what of a voxel's classes counts");
  list.add("least_probability", leastProbability, "", between(0, 1),
           "less probable classes do not count (expected, cautious)");
}

void ClassReading::validate() const { strict_files::checkOptions(*this, "ClassReading"); }

}  // namespace semantic_planning
