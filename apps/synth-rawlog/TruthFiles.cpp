#include "TruthFiles.h"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace synth_rawlog {
namespace {

using synthetic_world::classTable;
using synthetic_world::PointTruth;

const char* nameOf(PointTruth::State state) {
  switch (state) {
    case PointTruth::State::Free:
      return "free";
    case PointTruth::State::Surface:
      return "surface";
    case PointTruth::State::Inside:
      return "inside";
    default:
      return "underground";
  }
}

/** The point of a line, or nothing if the line is blank or a comment. */
std::optional<Eigen::Vector3d> pointOf(const std::string& line, const std::string& where) {
  if (line.find_first_not_of(" \t\r") == std::string::npos || line[0] == '#') return std::nullopt;
  std::istringstream in(line);
  Eigen::Vector3d p;
  std::string rest;
  if (!(in >> p.x() >> p.y() >> p.z()) || in >> rest)
    throw std::runtime_error(where + ": three numbers expected: x y z");
  return p;
}

}  // namespace

void writeTruth(const Cli& cli, int frames, const std::filesystem::path& file) {
  strict_files::StagedFile staged(file);
  std::ofstream out(staged.path());
  out << "# The world that " << cli.output.filename().string() << " shows.\n"
      << "scene: " << cli.scene << "\nseed: " << cli.seed << "\nhills: " << cli.hills
      << "\nframes: " << frames << "\nlabel_noise: " << cli.noise.label << "\nclasses:\n";
  for (synthetic_world::ClassId id = 1; id <= classTable().size(); ++id) {
    const auto c = classTable().color(id);
    out << "  - {id: " << +id << ", name: " << classTable().name(id) << ", color: [" << +c.r << ", "
        << +c.g << ", " << +c.b << "]}\n";
  }
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
  out.close();
  staged.commit();
}

TrajectoryWriter::TrajectoryWriter(const std::filesystem::path& target)
    : m_file(target), m_stream(m_file.path()) {
  m_stream << "# time x y z qx qy qz qw (true poses of the robot)\n" << std::fixed;
}

void TrajectoryWriter::write(double time, const mrpt::poses::CPose3D& T_map_robot) {
  mrpt::math::CQuaternionDouble q;
  T_map_robot.getAsQuaternion(q);
  m_stream << std::setprecision(6) << time << std::setprecision(9);
  for (const double v :
       {T_map_robot.x(), T_map_robot.y(), T_map_robot.z(), q.x(), q.y(), q.z(), q.r()})
    m_stream << ' ' << v;
  m_stream << '\n';
}

void TrajectoryWriter::commit() {
  if (!m_stream.flush()) throw std::runtime_error(m_file.path().string() + ": cannot be written");
  m_stream.close();
  m_file.commit();
}

void answerTruth(const synthetic_world::World& world, double tolerance, std::istream& points,
                 const std::string& name, std::ostream& out) {
  int number = 0;
  for (std::string line; std::getline(points, line);) {
    const auto p = pointOf(line, name + ", line " + std::to_string(++number));
    if (!p) continue;
    const PointTruth truth = world.at(*p, tolerance);
    out << p->x() << ' ' << p->y() << ' ' << p->z() << ' ' << nameOf(truth.state) << ' '
        << +truth.id << ' '
        << (truth.id == synthetic_world::kNoClass ? "-" : classTable().name(truth.id)) << '\n';
  }
}

}  // namespace synth_rawlog
