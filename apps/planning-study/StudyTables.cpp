#include "StudyTables.h"

#include <iomanip>
#include <sstream>

namespace planning_study {

using nlohmann::ordered_json;

namespace {

std::string fixed(double value, int digits) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << value;
  return out.str();
}

std::string rounded(const ordered_json& number, int digits = 1) {
  return fixed(number.get<double>(), digits);
}

std::string percent(const ordered_json& share) { return fixed(100 * share.get<double>(), 0); }

std::string withInterval(const ordered_json& e) {
  return rounded(e["value"], 2) + " (" + rounded(e["low"], 2) + ", " + rounded(e["high"], 2) + ")";
}

void row(std::ostream& out, const std::vector<std::string>& cells) {
  for (const std::string& cell : cells) out << "| " << cell << ' ';
  out << "|\n";
}

void head(std::ostream& out, const std::vector<std::string>& cells) {
  row(out, cells);
  row(out, std::vector<std::string>(cells.size(), "---"));
}

void writeWays(std::ostream& out, const ordered_json& map) {
  head(out, {"graph", "judgment", "budget", "memory", "solved %", "planning ms: mean", "deviation",
             "median", "95th", "graph ms", "edges evaluated", "outside best m", "length m"});
  for (const ordered_json& way : map["ways"]) {
    const auto &planning = way["milliseconds"]["planning"], &graph = way["milliseconds"]["graph"];
    row(out, {way["graph"], way["judgment"], way["budget"].dump(), way["memory"],
              percent(way["success"]["value"]), rounded(planning["mean"]),
              rounded(planning["deviation"]), rounded(planning["median"]),
              rounded(planning["percentile95"]), rounded(graph["mean"], 0),
              rounded(way["edgesEvaluated"]["mean"], 0), rounded(way["metersOutsideBest"]["mean"]),
              rounded(way["meters"]["mean"])});
  }
}

std::string nameOf(const ordered_json& key) {
  return key["graph"].get<std::string>() + " " + key["budget"].dump() + ", " +
         key["judgment"].get<std::string>() + ", " + key["memory"].get<std::string>();
}

void writePairs(std::ostream& out, const ordered_json& map) {
  head(out, {"a", "b", "solved by both", "a better / equal / worse", "a not worse %",
             "planning: ratio of means", "ratio of deviations", "outside best, a - b, m"});
  for (const ordered_json& pair : map["pairs"]) {
    const auto &way = pair["way"], &planning = pair["milliseconds"]["planning"];
    row(out, {nameOf(pair["a"]), nameOf(pair["b"]),
              pair["solvedByBoth"].dump() + " of " + pair["pairs"].dump(),
              way["better"].dump() + " / " + way["equal"].dump() + " / " + way["worse"].dump(),
              percent(way["notWorse"]["value"]) + " (" + percent(way["notWorse"]["low"]) + ", " +
                  percent(way["notWorse"]["high"]) + ")",
              withInterval(planning["ratioOfMeans"]), withInterval(planning["ratioOfDeviations"]),
              withInterval(pair["metersOutsideBest"]["difference"])});
  }
}

}  // namespace

std::string toMarkdown(const ordered_json& study) {
  std::ostringstream out;
  for (const ordered_json& map : study["maps"]) {
    out << "## " << map["name"].get<std::string>() << "\n\n"
        << map["instances"] << " tasks; " << map["knownLeaves"] << " leaves, compressed "
        << map["compressedKnownLeaves"] << "; abstraction "
        << rounded(map["milliseconds"]["abstraction"], 0) << " ms, ground "
        << rounded(map["milliseconds"]["ground"], 0) << " ms\n\n";
    writeWays(out, map);
    out << '\n';
    writePairs(out, map);
    out << '\n';
  }
  return out.str();
}

}  // namespace planning_study
