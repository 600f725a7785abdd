#include <strict_files/TextFile.h>

#include <sstream>

#include "Summary.h"

namespace planning_study {

using strict_files::csvField;

namespace {

/** Numbers of a vector, in a column of their own. */
template <class Numbers>
void writeVector(std::ostream& out, const Numbers& numbers) {
  out << ',';
  for (std::size_t i = 0; i < numbers.size(); ++i) out << (i ? " " : "") << numbers[i];
}

/** Meters and radians. */
void writePose(std::ostream& out, const mrpt::math::TPose2D& pose) {
  out << ',' << pose.x << ',' << pose.y << ',' << pose.phi;
}

void writeTrial(std::ostream& out, const Trial& t) {
  out << csvField(t.map) << ',' << t.instance;
  writePose(out, t.task.start);
  writePose(out, t.task.goal);
  out << ',' << t.judgment << ',' << t.graph << ',' << t.budget << ',' << memoryName(t.kept) << ','
      << t.found << ',' << csvField(t.status) << ',' << t.vertices << ',' << t.edges << ','
      << t.evaluated << ',' << t.expansions;
  writeVector(out, t.cost);
  writeVector(out, t.way);
  out << ',' << t.graphTime << ',' << t.evaluationTime << ',' << t.searchTime << ','
      << t.timeToFirstPath() << '\n';
}

}  // namespace

std::string toCsv(const std::vector<MapStudy>& maps) {
  std::ostringstream out;
  out << "map,instance,start x,start y,start heading,goal x,goal y,goal "
         "heading,judgment,graph,budget,memory,found,status,vertices,edges,"
         "edges evaluated,expansions,cost [0.1 mm],way [0.1 mm],graph [ms],evaluation [ms],"
         "search [ms],first path [ms]\n";
  for (const MapStudy& map : maps)
    for (const Trial& trial : map.trials) writeTrial(out, trial);
  return out.str();
}

}  // namespace planning_study
