#include "Summary.h"

#include <map_operations/MapOperations.h>
#include <semantic_abstraction/Abstraction.h>

#include <sstream>

#include "measuring/Measuring.h"

namespace rawlog2semantic_map {

using nlohmann::ordered_json;
using semantic_octree::MapContents;
using semantic_octree::SemanticOcTree;

void Summary::add(const labeled_cloud::ScanCounts& counts) {
  conversion.points += counts.points;
  conversion.labeled += counts.labeled;
  conversion.invalid += counts.invalid;
  conversion.flying += counts.flying;
}

void Summary::add(const semantic_octree::InsertionReport& report) {
  insertion.points += report.points;
  insertion.skippedNotFinite += report.skippedNotFinite;
  insertion.skippedNear += report.skippedNear;
  insertion.skippedOutside += report.skippedOutside;
  insertion.beyondRange += report.beyondRange;
  insertion.hitVoxels += report.hitVoxels;
  insertion.freeVoxels += report.freeVoxels;
}

void Summary::addProblems(const std::vector<std::string>& more) {
  constexpr std::size_t kMostListed = 100;
  numProblems += more.size();
  for (const std::string& problem : more)
    if (problems.size() < kMostListed) problems.push_back(problem);
}

std::string Summary::note(const labeled_cloud::StreamedObservation& observation) {
  if (observation.scan) return ++inserted, "inserted";
  if (observation.skipped.empty()) return ++pictures, "a picture";
  if (observation.holdsPose && posesAreUsed) return ++poses, "a pose";
  ++skipped[observation.skipped];
  return "skipped, " + observation.skipped;
}

std::optional<semantic_octree::LabelReliability> Summary::labelReliability() const {
  if (labels.empty()) return std::nullopt;
  std::vector<double> accuracies, correlations;
  for (const semantic_octree::LabelReliability& scan : labels) {
    accuracies.push_back(scan.accuracy);
    correlations.push_back(scan.correlation);
  }
  return semantic_octree::LabelReliability{measuring::quantile(accuracies, 0.5),
                                           measuring::quantile(correlations, 0.5)};
}

std::size_t Summary::numSkipped() const { return read - inserted - pictures - poses; }

std::string Summary::skippedText() const {
  std::string text = std::to_string(numSkipped()) + " skipped";
  const char* separator = " (";
  for (const auto& [reason, count] : skipped) {
    text += separator + std::to_string(count) + " " + reason;
    separator = ", ";
  }
  return skipped.empty() ? text : text + ")";
}

std::string Summary::labeledText() const {
  std::ostringstream text;
  text.precision(3);
  const double share =
      static_cast<double>(conversion.labeled) / static_cast<double>(conversion.points);
  text << 100 * share << " % of " << conversion.points << " points have a label";
  if (withoutLabels > 0) text << "; " << withoutLabels << " of " << inserted << " scans found none";
  if (share < 0.5)
    text << ". Warning: less than half. That is usual for one camera over a LiDAR. Otherwise see "
            "--preview: times of label images, `fit` of the network, ids of the class table";
  return text.str();
}

namespace {

/** All 0 if there are none. */
ordered_json timesJson(const std::vector<double>& milliseconds) {
  const auto at = [&](double share) {
    return milliseconds.empty() ? 0 : measuring::quantile(milliseconds, share);
  };
  return {{"median", at(0.5)}, {"percentile95", at(0.95)}};
}

ordered_json pointsJson(const Summary& s) {
  return {{"read", s.conversion.points + s.conversion.invalid + s.conversion.flying},
          {"withoutRange", s.conversion.invalid},
          {"flying", s.conversion.flying},
          {"tooNear", s.insertion.skippedNear},
          {"outsideTheMap", s.insertion.skippedOutside},
          {"beyondMaxRange", s.insertion.beyondRange},
          {"labeled", s.conversion.labeled}};
}

ordered_json mapJson(const SemanticOcTree& tree, bool countVoxels) {
  if (!countVoxels)
    return {{"resolution", tree.getResolution()},
            {"leaves", tree.getNumLeafNodes()},
            {"innerNodes", tree.size() - tree.getNumLeafNodes()}};
  const MapContents contents = contentsOf(tree);
  ordered_json classes = ordered_json::object();
  for (int id = 1; id <= tree.numClasses(); ++id)
    classes[tree.classes().name(static_cast<semantic_types::ClassId>(id))] =
        contents.voxelsOfClass[id];
  return {{"resolution", tree.getResolution()},
          {"leaves", contents.leaves},
          {"innerNodes", contents.innerNodes},
          {"bytes", contents.bytes},
          {"freeVoxels", contents.freeVoxels},
          {"occupiedVoxels", contents.occupiedVoxels},
          {"occupiedWithoutClass", contents.voxelsOfClass[0]},
          {"voxelsPerClass", classes}};
}

ordered_json abstractionJson(const Summary& s) {
  const AbstractionSummary& a = s.abstraction;
  ordered_json scans = ordered_json::array();
  for (std::size_t i = 0; i < a.leaves.size(); ++i) {
    ordered_json scan = {{"leaves", a.leaves[i]},
                         {"compressedLeaves", a.compressedLeaves[i]},
                         {"insertionMilliseconds", s.insertionTimes[i]},
                         {"changeMilliseconds", a.changeTimes[i]}};
    if (!a.insertionTimesWithout.empty())
      scan["insertionMillisecondsWithout"] = a.insertionTimesWithout[i];
    scans.push_back(scan);
  }
  ordered_json json = {{"change", timesJson(a.changeTimes)}, {"scans", scans}};
  if (!a.insertionTimesWithout.empty())
    json["insertionWithout"] = timesJson(a.insertionTimesWithout);
  return json;
}

}  // namespace

ordered_json toJson(const Summary& s, const SemanticOcTree& tree, bool countVoxels) {
  ordered_json json = {
      {"rawlogs", s.rawlogs},
      {"stopped", s.stopped},
      {"observations",
       {{"read", s.read},
        {"inserted", s.inserted},
        {"insertedWithoutLabels", s.withoutLabels},
        {"pictures", s.pictures},
        {"poses", s.poses},
        {"skipped", s.skipped}}},
      {"problems", {{"count", s.numProblems}, {"first", s.problems}}},
      {"points", pointsJson(s)},
      {"millisecondsPerScan",
       {{"conversion", timesJson(s.conversionTimes)}, {"insertion", timesJson(s.insertionTimes)}}},
      {"map", mapJson(tree, countVoxels)}};
  if (const auto labels = s.labelReliability())
    json["labels"] = {{"accuracy", labels->accuracy}, {"correlation", labels->correlation}};
  if (s.slam)
    json["slam"] = {{"keyframes", s.slam->keyframes},
                    {"loops", s.slam->loops},
                    {"referenced", s.slam->referenced},
                    {"lost", s.slam->lost},
                    {"torn", s.slam->torn},
                    {"undone", s.slam->undone},
                    {"way", s.slam->way},
                    {"odometry_way_error", s.slam->wayError},
                    {"odometry_turn_error", s.slam->turnError},
                    {"warnings", s.slam->warnings()}};
  if (hasAbstraction(tree)) json["abstraction"] = abstractionJson(s);
  return json;
}

}  // namespace rawlog2semantic_map
