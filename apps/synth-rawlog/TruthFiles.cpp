#include "TruthFiles.h"

#include <semantic_types/ClassTable.h>
#include <strict_files/StrictYaml.h>
#include <strict_files/Words.h>

#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "synthetic_rawlog/Observations.h"

namespace synth_rawlog {

using synthetic_world::ClassId;

WorldClasses::WorldClasses(const std::filesystem::path& file)
    : m_table(file.empty() ? synthetic_world::classTable() : semantic_types::loadClassTable(file)),
      m_ids{synthetic_world::kNoClass} {
  const auto fail = [&file](const std::string& what) {
    throw std::runtime_error(file.string() + ": " + what);
  };
  if (m_table.size() > synthetic_rawlog::kMostPixelClasses)
    fail(std::to_string(m_table.size()) + " classes, and a pixel's labels hold 31");
  for (int id = 1; id <= synthetic_world::kClassCount; ++id) try {
      m_ids.push_back(m_table.fromRaw(static_cast<std::uint32_t>(id)));
    } catch (const std::invalid_argument& e) {
      fail(e.what());
    }
}

synthetic_world::CameraFrame WorldClasses::of(synthetic_world::CameraFrame frame) const {
  for (ClassId& id : frame.labels.pixels) id = of(id);
  return frame;
}

synthetic_world::LabeledCloud WorldClasses::of(synthetic_world::LabeledCloud cloud) const {
  for (ClassId& id : cloud.classes) id = of(id);
  return cloud;
}

namespace {

using synthetic_world::PointTruth;

const char* nameOf(PointTruth::State state) {
  switch (state) {
    case PointTruth::State::Free:
      return "free";
    case PointTruth::State::Surface:
      return "surface";
    case PointTruth::State::Inside:
      return "inside";
    case PointTruth::State::Underground:
      break;
  }
  return "underground";
}

}  // namespace

void writeTruth(const Cli& cli, const WorldClasses& classes, int frames,
                const std::filesystem::path& file) {
  std::ostringstream out;
  out << "# The world that " << strict_files::printable(cli.output.filename().string())
      << " shows.\n"
      << "scene: " << cli.scene << "\nseed: " << cli.seed << "\nhills: " << cli.hills
      << "\nframes: " << frames << "\nlabel_noise: " << cli.noise.label << "\nclasses:\n";
  const synthetic_world::ClassTable& table = classes.table();
  for (synthetic_world::ClassId id = 1; id <= table.size(); ++id) {
    const auto c = table.color(id);
    out << "  - {id: " << +id << ", name: " << strict_files::yamlText(table.name(id))
        << ", color: [" << +c.r << ", " << +c.g << ", " << +c.b << "]}\n";
  }
  strict_files::writeText(file, out.str());
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

void answerTruth(const synthetic_world::World& world, const WorldClasses& classes, double tolerance,
                 const std::vector<strict_files::TextLine>& points, std::ostream& out) {
  for (const strict_files::TextLine& line : points) {
    const std::vector<double> p = numbersOf(line, 3);
    const PointTruth truth = world.at({p[0], p[1], p[2]}, tolerance);
    const synthetic_world::ClassId id = classes.of(truth.id);
    out << p[0] << ' ' << p[1] << ' ' << p[2] << ' ' << nameOf(truth.state) << ' ' << +id << ' '
        << (id == synthetic_world::kNoClass ? "-" : classes.table().name(id)) << '\n';
  }
}

}  // namespace synth_rawlog
