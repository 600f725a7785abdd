#include "MapBuilder.h"

#include <labeled_cloud/Trajectory.h>
#include <map_folders/MapFolder.h>
#include <map_operations/MapOperations.h>
#include <strict_files/Words.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <future>
#include <iomanip>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "inputs/Inputs.h"
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
  insertion.skippedNear += report.skippedNear;
  insertion.skippedOutside += report.skippedOutside;
  insertion.beyondRange += report.beyondRange;
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
  for (std::size_t i = 0; i < a.leaves.size(); ++i)
    scans.push_back({{"leaves", a.leaves[i]},
                     {"compressedLeaves", a.compressedLeaves[i]},
                     {"insertionMilliseconds", s.insertionTimes[i]},
                     {"changeMilliseconds", a.changeTimes[i]}});
  return {{"change", timesJson(a.changeTimes)}, {"scans", scans}};
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

namespace fs = std::filesystem;
using labeled_cloud::LabeledScan;
using labeled_cloud::StreamedObservation;
using mrpt::poses::CPose3D;

namespace {

/** Milliseconds that an action takes. */
template <typename Action>
double timeOf(Action action) {
  const measuring::Stopwatch watch;
  action();
  return watch.milliseconds();
}

std::uint64_t totalSize(const std::vector<fs::path>& files) {
  std::uint64_t bytes = 0;
  for (const fs::path& file : files) bytes += fs::file_size(file);
  return bytes;
}

}  // namespace

MapBuilder::MapBuilder(semantic_map::CSemanticOctoMap& map,
                       const labeled_cloud::Trajectory& trajectory, OnScan onScan)
    : m_map(map),
      m_trajectory(trajectory),
      m_follower(map.tree()),
      m_calibrator(map.tree().getResolution(), map.tree().numClasses()),
      m_hadContent(!map.isEmpty()),
      m_onScan(std::move(onScan)) {}

void MapBuilder::correctPoses(const semantic_slam::SlamOptions& options, const fs::path& folder,
                              const fs::path& reference) {
  semantic_slam::MapperOptions mapping;
  mapping.insertion = m_map.insertionOptions.scan;
  mapping.localize = true;
  mapping.slam = options;
  mapping.scans = folder;
  mapping.forgetsFrom = SIZE_MAX;
  if (m_hadContent)
    notes() << "There is a map: poses are corrected to be in its frame, and scans stay where they "
               "are put"
            << std::endl;
  if (reference.empty()) {
    m_mapper.emplace(m_map.tree(), mapping);
    return;
  }
  const semantic_octree::SemanticOcTree map = inputs::loadMap(reference);
  if (options.useClasses && map.classes() != m_map.tree().classes())
    throw std::runtime_error(reference.string() +
                             ": its class table is another one than that of the scans");
  m_mapper.emplace(m_map.tree(), mapping, &map);
}

void MapBuilder::insert(const std::vector<fs::path>& rawlogs, labeled_cloud::ScanStream& stream,
                        const StopRequest& stop) {
  for (const fs::path& file : rawlogs) m_summary.rawlogs.push_back(file.string());
  std::optional<Progress> progress(std::in_place, "Mapping", totalSize(rawlogs));
  const auto makeNext = [&stream] {
    return std::async(std::launch::async, [&stream] { return stream.next(); });
  };
  auto ahead = makeNext();
  while (auto observation = ahead.get()) {
    ahead = makeNext();
    deskew(*observation);
    add(*observation);
    if ((m_summary.stopped = stop.pending())) break;
    progress->update(observation->bytesRead, std::to_string(m_summary.inserted) + " scans");
  }
  if (m_mapper)
    m_mapper->finish();
  else
    m_map.tree().setCalibration(m_calibrator.fit(m_map.tree()));
  progress.reset();
  notes() << "Mapping: " << (m_summary.stopped ? "stopped early, " : "") << m_summary.inserted
          << " scans inserted, " << m_summary.skippedText() << std::endl;
  if (m_mapper) noteSlam();
  if (m_mapper && m_hadContent) checkFoundInMap();
  if (m_summary.conversion.points > 0 && m_map.tree().numClasses() > 1)
    notes() << m_summary.labeledText() << std::endl;
}

void MapBuilder::checkFoundInMap() const {
  if (m_summary.slam->referenced == 0)
    throw std::runtime_error(
        "no scan was found in the map that is there: nothing is added to it; poses have to begin "
        "near where the robot is in it, and another place needs a folder of its own");
}

void MapBuilder::deskew(StreamedObservation& observation) const {
  if (m_mapper || !observation.scan || observation.scan->times.empty()) return;
  LabeledScan& scan = *observation.scan;
  const auto isNearer = [](float a, float b) { return std::abs(a) < std::abs(b); };
  const double time = *std::max_element(scan.times.begin(), scan.times.end(), isNearer);
  const auto T_map_then =
      m_trajectory.at(mrpt::Clock::fromDouble(mrpt::Clock::toDouble(scan.timestamp) + time));
  if (!T_map_then || time == 0) return;
  semantic_slam::SensorScan skewed{std::move(scan.cloud),
                                   labeled_cloud::toEigen(scan.T_robot_sensor)};
  skewed.times = std::exchange(scan.times, {});
  const auto T_then = labeled_cloud::toEigen(*T_map_then - observation.T_map_robot);
  scan.cloud = deskewed(std::move(skewed), semantic_slam::velocityOf(T_then, time)).cloud;
}

void MapBuilder::add(const StreamedObservation& observation) {
  ++m_summary.read;
  m_summary.addProblems(observation.problems);
  if (observation.scan) insertScan(observation);
  const std::string use = m_summary.note(observation);
  details() << observation.name << ": " << use << std::endl;
}

void MapBuilder::insertScan(const StreamedObservation& observation) try {
  const LabeledScan& scan = *observation.scan;
  semantic_octree::InsertionReport report;
  CPose3D T_map_robot = observation.T_map_robot;
  m_summary.insertionTimes.push_back(timeOf([&] { report = insertIntoMap(scan, T_map_robot); }));
  m_summary.add(report);
  m_summary.add(scan.counts);
  m_summary.withoutLabels += scan.labelsMissing;
  m_summary.conversionTimes.push_back(observation.milliseconds);
  if (hasAbstraction(m_map.tree())) noteAbstraction();
  if (m_onScan) m_onScan(scan, T_map_robot);
} catch (const std::exception& e) {
  throw std::runtime_error(observation.name + ": " + strict_files::messageOf(e));
}

semantic_octree::InsertionReport MapBuilder::insertIntoMap(const LabeledScan& scan,
                                                           CPose3D& T_map_robot) {
  if (!m_mapper) {
    const Eigen::Isometry3d T = labeled_cloud::toEigen(T_map_robot + scan.T_robot_sensor);
    m_calibrator.add(scan.cloud, T, m_map.insertionOptions.scan);
    return m_map.insertScan(scan, T_map_robot);
  }
  m_clock.setMaxGap(m_map.insertionOptions.maxGap);
  m_seconds += m_clock.secondsUntil(scan.timestamp);
  std::optional<Eigen::Isometry3d> T_odometry_robot;
  if (m_hasOdometry) T_odometry_robot = labeled_cloud::toEigen(T_map_robot);
  semantic_slam::SensorScan seen{scan.withEmpty(), labeled_cloud::toEigen(scan.T_robot_sensor),
                                 scan.emptyFrom, scan.times};
  if (!seen.times.empty()) seen.times.resize(seen.cloud.size());
  const auto inserted = m_mapper->insert(seen, T_odometry_robot, m_seconds);
  if (!m_hasOdometry) T_map_robot = labeled_cloud::toMrpt(inserted.place.T_map_robot);
  m_clock.note(scan.timestamp);
  const semantic_slam::Slam::Added& added = *inserted.place.added;
  m_placed.push_back(
      {mrpt::Clock::toDouble(scan.timestamp), added.keyframe, added.T_keyframe_robot});
  return inserted.scans.front();
}

void MapBuilder::noteSlam() {
  m_summary.slam = m_mapper->slam()->report();
  const semantic_slam::SlamReport& report = *m_summary.slam;
  notes() << "Poses: " << std::lround(report.way) << " m of way, " << report.keyframes
          << " keyframes, " << report.loops << " loops; " << report.lost << " of " << report.scans
          << " scans fit nothing that was seen before" << std::endl;
  for (const std::string& warning : report.warnings())
    notes() << "Warning: " << warning << std::endl;
}

std::string MapBuilder::trajectory() const {
  std::ostringstream out;
  for (const PlacedScan& scan : m_placed) {
    const Eigen::Isometry3d T = m_mapper->slam()->poses()[scan.keyframe] * scan.T_keyframe_robot;
    const Eigen::Quaterniond q(T.linear());
    out << std::fixed << std::setprecision(6) << scan.seconds << std::setprecision(9);
    for (const double x : {T.translation().x(), T.translation().y(), T.translation().z(), q.x(),
                           q.y(), q.z(), q.w()})
      out << ' ' << x;
    out << '\n';
  }
  return out.str();
}

void MapBuilder::noteAbstraction() {
  AbstractionSummary& a = m_summary.abstraction;
  a.changeTimes.push_back(timeOf([&] { m_follower.leaves(); }));
  a.compressedLeaves.push_back(m_follower.skipLeaves());
  a.leaves.push_back(m_map.tree().getNumLeafNodes());
}

}  // namespace rawlog2semantic_map
