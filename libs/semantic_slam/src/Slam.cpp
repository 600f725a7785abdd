#include <semantic_slam/Slam.h>

#include <semantic_slam/SlamOptions.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "SlamEngine.h"

namespace semantic_slam {
namespace {

std::string percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

std::string tenths(double x) {
  const long n = std::lround(10 * x);
  return std::to_string(n / 10) + "." + std::to_string(n % 10);
}

/** Scans turn by less if their beams are said to be nearer to each other than they are. */
std::string asOfBeams(double turnError) {
  constexpr double kLeastError = 0.4;  // no wheels are that wrong
  if (turnError < kLeastError) return {};
  return ", as if the scanner's aperture were " + tenths(1 + turnError) +
         " times what the rawlog says";
}

}  // namespace

SensorScan deskewed(SensorScan scan, const Vector6& velocity, double at) {
  const std::vector<float> times = std::exchange(scan.times, {});
  if (times.empty() || velocity == Vector6::Zero()) return scan;
  if (times.size() != scan.cloud.size())
    throw std::invalid_argument("a scan with " + std::to_string(times.size()) + " times of " +
                                std::to_string(scan.cloud.size()) + " points");
  const Eigen::Isometry3d T_sensor_robot = scan.T_robot_sensor.inverse();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  double since = 0;  // beams of one firing have one time
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (const double s = static_cast<double>(times[i]) - at; s != since)
      T = T_sensor_robot * movedFor(since = s, velocity) * scan.T_robot_sensor;
    Eigen::Vector3f& p = scan.cloud.points[i];
    if (since != 0) p = (T * p.cast<double>()).cast<float>();
  }
  return scan;
}

std::vector<std::string> SlamReport::warnings() const {
  constexpr double kMostLost = 0.05, kMostWrong = 0.15;
  constexpr double kLeastWay = 20,
                   kMostStanding = 2;  // m; odometry of real robots lags by some decimeters
  std::vector<std::string> warnings;
  if (scans > 1 && way < 0.01 * static_cast<double>(scans) && way < 1)
    warnings.push_back("the robot does not seem to move: all scans are at one place");
  if (static_cast<double>(lost) > kMostLost * static_cast<double>(scans))
    warnings.push_back(percent(static_cast<double>(lost) / static_cast<double>(scans)) +
                       " of the scans fit nothing that was seen before, and are where odometry has "
                       "them: the map is probably wrong there");
  const auto lostAt = [](std::size_t places) {
    return (places == 1 ? "at one place" : "at " + std::to_string(places) + " places") +
           std::string(" scans fit nothing that was seen before, and ");
  };
  if (torn > joined)
    warnings.push_back(
        lostAt(torn - joined) +
        (hasOdometry ? "only odometry leads across: parts of the map are beside each other if it "
                       "errs, if the robot was carried, or if a part of the log is missing"
                     : "there is no odometry: parts of the map may be beside each other; poses of "
                       "odometry help"));
  if (joined > 0)
    warnings.push_back(lostAt(joined) + "the robot was found again up to " + tenths(carried) +
                       " m from where odometry has it: it was carried, a part of the log is "
                       "missing, or odometry erred");
  if (undone > loops)
    warnings.push_back("more places seem to be seen again than fit together (" +
                       std::to_string(undone) + " loops were undone): the map may be torn");
  if (open > 0)
    warnings.push_back("at the end of the way the robot may be in either of two places, by " +
                       std::to_string(open) +
                       " of its looks, and no loop was closed: what was seen twice there may be "
                       "drawn twice");
  if (apart > 0)
    warnings.push_back("places that were seen twice are drawn up to " + tenths(apart) +
                       " m beside themselves: the map is wrong there");
  if (unheld > kLeastWay)
    warnings.push_back(std::to_string(std::lround(unheld)) +
                       " m of the way had no hold along corridors or walls: " +
                       (hasOdometry ? "the wheels alone placed the robot there"
                                    : "it was taken to go on as before"));
  if (standing > kMostStanding)
    warnings.push_back("odometry stood still while the robot drove " + tenths(standing) +
                       " m by its scans: the map may be wrong there");
  const double wayOfOdometry = way * std::abs(1 + wayError);
  if (hasOdometry && wayError < -1 && way > kLeastWay)
    warnings.push_back(
        "scans move backward where odometry goes ahead: the sensor's pose on the robot is wrong");
  else if (hasOdometry && std::max(way, wayOfOdometry) > kLeastWay &&
           std::abs(wayError) > kMostWrong)
    warnings.push_back("odometry says " + percent(std::abs(wayError)) +
                       (wayError > 0 ? " more" : " less") + " way than the scans do");
  if (hasOdometry && way > kLeastWay && std::abs(turnError) > kMostWrong)
    warnings.push_back("odometry turns " + percent(std::abs(turnError)) +
                       (turnError > 0 ? " more" : " less") + " than the scans do" +
                       (isPlanar ? asOfBeams(turnError) : ""));
  return warnings;
}

SlamReport SlamEngine::report() const {
  SlamReport report = m_report;
  report.keyframes = m_keyframes.size();
  const auto gaps = this->gaps();
  report.joined = gaps.size();
  for (const double gap : gaps) report.carried = std::max(report.carried, gap);
  if (!m_keyframes.empty()) report.torn += report.joined + parts().size() - 1;
  report.hasOdometry = m_hasOdometry;
  report.isPlanar = m_scale.isPlanar;
  if (m_wayOfScans != 0) report.wayError = m_wayOfOdometry / m_wayOfScans - 1;
  if (m_turnOfScans > 0) report.turnError = m_turnOfOdometry / m_turnOfScans - 1;
  return report;
}

Slam::Slam(const SlamOptions& options, const std::filesystem::path& folder) {
  options.validate();
  m = std::make_unique<SlamEngine>(options, folder);
}
Slam::~Slam() = default;
Slam::Slam(Slam&&) noexcept = default;

void Slam::setReference(const semantic_octree::SemanticOcTree& map) { m->setReference(map); }

Slam::Added Slam::add(const SensorScan& scan,
                      const std::optional<Eigen::Isometry3d>& T_odometry_robot, double seconds) {
  return m->add(scan, T_odometry_robot, seconds);
}

bool Slam::finish() { return m->finish(); }
std::vector<std::size_t> Slam::outnumbered(std::size_t by) const { return m->outnumbered(by); }
void Slam::forget(const std::vector<std::size_t>& keyframes) { m->forget(keyframes); }
const std::vector<Eigen::Isometry3d>& Slam::poses() const { return m->poses(); }
const std::vector<PoseEdge>& Slam::edges() const { return m->edges(); }
SlamReport Slam::report() const { return m->report(); }

void SlamOptions::describe(strict_files::OptionList& list) {
  list.add("use_classes", useClasses, "", "a point fits only points of its class");
  list.add("level", level, "",
           "odometry knows height, roll and pitch, as with an IMU; always so of horizontal beams");
}

void SlamOptions::validate() const { strict_files::checkOptions(*this, "SlamOptions"); }

}  // namespace semantic_slam
