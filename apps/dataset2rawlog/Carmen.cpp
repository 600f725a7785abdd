#include <labeled_cloud/Trajectory.h>
#include <mrpt/math/TPose2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <strict_files/OptionList.h>
#include <strict_files/TextFile.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>

#include "Conversion.h"

namespace dataset2rawlog {
namespace {

namespace fs = std::filesystem;
using mrpt::math::TPose2D;
using strict_files::TextLine;

/** The words of a line, one after the other. */
class Words {
 public:
  explicit Words(const TextLine& line) : m_line(line), m_stream(line.text) { m_stream >> kind; }

  std::string kind;  ///< the first one

  std::string word(const std::string& what) {
    std::string word;
    if (!(m_stream >> word)) fail("ends before " + what);
    return word;
  }
  double number(const std::string& what) {
    const std::string text = word(what);
    std::istringstream in(text);
    in.imbue(std::locale::classic());
    double number;
    if (!(in >> number) || !in.eof() || !std::isfinite(number))
      fail(what + " is no number: '" + text + "'");
    return number;
  }
  std::vector<double> numbers(const std::string& what) {
    constexpr double kMost = 1e5;
    const double count = number("the number of its " + what);
    if (!(count >= 0 && count <= kMost) || count != std::floor(count))
      fail("has no such number of " + what + ": " + strict_files::textOf(count));
    std::vector<double> numbers;
    while (static_cast<double>(numbers.size()) < count)
      numbers.push_back(number("number " + std::to_string(numbers.size() + 1) + " of " +
                               std::to_string(std::lround(count)) + " " + what));
    return numbers;
  }
  TPose2D pose(const std::string& what) {
    const double x = number("x of " + what), y = number("y of " + what);
    return {x, y, number("the heading of " + what)};
  }
  void skip(int numWords) {
    for (int i = 0; i < numWords; ++i) word("its time");
  }
  mrpt::Clock::time_point time() {
    try {
      return labeled_cloud::timeOfSeconds(number("its time"));
    } catch (const std::invalid_argument& e) {
      fail(e.what());
    }
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(m_line.where + ": " + kind + ": " + what);
  }

 private:
  const TextLine& m_line;
  std::istringstream m_stream;
};

struct Beams {
  double first = 0, step = 0;  ///< radians
  double maxRange = 0;         ///< m
};

class Log {
 public:
  explicit Log(const Conversion& conversion)
      : m_conversion(conversion), m_output(conversion, semantic_types::ClassTable()) {}

  void add(const TextLine& line) {
    Words words(line);
    if (words.kind == "PARAM") {
      const std::string name = words.word("its name");
      m_params.insert_or_assign(name, line);
    } else if (words.kind == "ODOM") {
      const TPose2D pose = words.pose("the robot");
      words.skip(3);  // speeds
      writeOdometry(pose, words.time());
    } else if (words.kind == "FLASER" || words.kind == "RLASER") {
      addOldLaser(words, words.kind == "FLASER");
    } else if (isNumbered(words.kind, "RAWLASER") || isNumbered(words.kind, "ROBOTLASER")) {
      addLaser(words, words.kind[1] == 'O');
    }
  }
  Summary finish(const fs::path& file) {
    if (m_frame == 0)
      throw std::runtime_error(file.string() +
                               ": no line FLASER, RLASER, RAWLASER1 or ROBOTLASER1: is it a log of "
                               "CARMEN's?");
    return m_output.finish();
  }

 private:
  static bool isNumbered(const std::string& kind, const std::string& name) {
    return kind.size() == name.size() + 1 && kind.compare(0, name.size(), name) == 0 &&
           kind.back() >= '1' && kind.back() <= '5';
  }

  /** Ranges, where the laser was (of corrected logs), odometry of the robot, time. */
  void addOldLaser(Words& words, bool isFront) {
    const std::vector<double> ranges = words.numbers("ranges");
    words.pose("the laser");
    const TPose2D pose = words.pose("the robot");
    const auto time = words.time();
    const std::string side = isFront ? "front" : "rear";
    const double step = stepOf(ranges.size(), side, words);
    const Beams beams{-0.5 * step * (static_cast<double>(ranges.size()) - 1), step,
                      param("robot_" + side + "_laser_max", 80)};
    const TPose2D T_robot_laser{param("robot_" + side + "laser_offset", 0), 0, isFront ? 0 : M_PI};
    writeOdometry(pose, time);
    writeScan(words, ranges, beams, T_robot_laser, time);
  }
  /** Beams, ranges, remissions; with the robot's pose or without. */
  void addLaser(Words& words, bool hasPose) {
    words.word("its type");
    Beams beams;
    beams.first = words.number("its first angle");
    const double aperture = words.number("its field of view");
    beams.step = words.number("its resolution");
    beams.maxRange = words.number("its largest range");
    words.skip(2);  // accuracy, kind of remissions
    const std::vector<double> ranges = words.numbers("ranges");
    words.numbers("remissions");
    const double between = std::max<double>(1, static_cast<double>(ranges.size()) - 1);
    if (!(beams.step > 0)) beams.step = aperture / between;
    if (std::abs(beams.step * between - aperture) > 1.5 * beams.step)
      words.fail(std::to_string(ranges.size()) + " ranges, " + strict_files::textOf(beams.step) +
                 " radians from each other, do not fill its field of view of " +
                 strict_files::textOf(aperture));
    TPose2D T_robot_laser{0, 0, 0};
    if (!hasPose) return writeScan(words, ranges, beams, T_robot_laser, words.time());
    const TPose2D laser = words.pose("the laser"), robot = words.pose("the robot");
    T_robot_laser = laser - robot;
    words.skip(5);  // speeds, distances, turn axis
    const auto time = words.time();
    writeOdometry(robot, time);
    writeScan(words, ranges, beams, T_robot_laser, time);
  }

  /** The line does not say how far beams are from each other: SICK scanners are known by how many
   * they have. Radians. */
  double stepOf(std::size_t numRanges, const std::string& side, const Words& words) const {
    constexpr double kDegree = M_PI / 180;
    for (const auto& [degrees, most] : {std::pair(1., 181u), {0.5, 361u}, {0.25, 401u}})
      if (numRanges == most || numRanges == most - 1) return degrees * kDegree;
    const std::string name = "laser_" + side + "_laser_resolution";
    const double degrees = param(name, 0);
    if (!(degrees > 0))
      words.fail(std::to_string(numRanges) +
                 " ranges: how far they are from each other is not known; a line 'PARAM " + name +
                 " DEGREES' before it says so");
    return degrees * kDegree;
  }

  double param(const std::string& name, double otherwise) const {
    const auto found = m_params.find(name);
    if (found == m_params.end()) return otherwise;
    Words words(found->second);
    words.word("its name");
    return words.number(name);
  }

  void writeOdometry(const TPose2D& pose, mrpt::Clock::time_point time) {
    mrpt::obs::CObservationOdometry odometry;
    odometry.timestamp = time;
    odometry.sensorLabel = "ODOMETRY";
    odometry.odometry = mrpt::poses::CPose2D(pose);
    m_output.writeOther(odometry);
  }
  void writeScan(const Words& words, const std::vector<double>& ranges, const Beams& beams,
                 const TPose2D& T_robot_laser, mrpt::Clock::time_point time) {
    if (!m_output.wants(m_frame++)) return;
    if (ranges.size() < 2) words.fail("has fewer than two ranges");
    const double aperture = beams.step * static_cast<double>(ranges.size() - 1);
    if (!(aperture <= 2 * M_PI)) words.fail("has beams of more than 360 degrees");
    if (const auto [last, isNew] = m_lasts.try_emplace(words.kind, time); !isNew) {
      if (time < last->second) words.fail("is of a time before the one before it");
      last->second = time;
    }
    mrpt::obs::CObservation2DRangeScan scan;
    scan.timestamp = time;
    scan.sensorLabel = words.kind;
    scan.aperture = static_cast<float>(aperture);
    scan.rightToLeft = true;
    scan.maxRange = static_cast<float>(beams.maxRange);
    scan.sensorPose =
        mrpt::poses::CPose3D(T_robot_laser + TPose2D{0, 0, beams.first + 0.5 * aperture});
    scan.resizeScan(ranges.size());
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      scan.setScanRange(i, static_cast<float>(ranges[i]));
      scan.setScanRangeValidity(i, ranges[i] > 0 && ranges[i] < beams.maxRange);
    }
    m_output.writeScan(scan, ranges.size(), 0);
  }

  const Conversion& m_conversion;
  Output m_output;
  std::map<std::string, TextLine> m_params;
  std::map<std::string, mrpt::Clock::time_point> m_lasts;  ///< times of scans
  std::size_t m_frame = 0;
};

}  // namespace

Summary convertCarmen(const fs::path& file, const Conversion& conversion) {
  Log log(conversion);
  for (const TextLine& line : strict_files::readLines(file)) log.add(line);
  return log.finish(file);
}

}  // namespace dataset2rawlog
