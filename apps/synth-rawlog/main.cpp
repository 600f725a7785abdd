// Drives a robot through a synthetic world and writes what its labeled sensors see.
#include <mrpt/poses/CPose3D.h>
#include <semantic_types/ClassTable.h>
#include <strict_files/StrictYaml.h>
#include <strict_files/TextFile.h>
#include <strict_files/Words.h>
#include <synthetic_world/Scene.h>
#include <synthetic_world/Sensors.h>
#include <synthetic_world/Solids.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <filesystem>
#include <iomanip>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "Application.h"
#include "label_noise/LabelNoise.h"
#include "synthetic_rawlog/Observations.h"

namespace synth_rawlog {

using strict_files::above;
using strict_files::between;
using strict_files::OptionList;
using synthetic_world::ClassId;
using namespace synthetic_rawlog;
namespace {

/** The command line. */
struct Cli {
  std::filesystem::path output;  // the rawlog
  std::string scene = "village";
  std::uint64_t seed = 1;
  double hills = 1;  // factor

  std::string sensor = "both";  // camera, lidar, both
  int frames = 0;               // 0: one round
  double rate = 2;              // frames a second
  double speed = 2.5;           // m/s
  double start = 0;             // m along the route
  int people = 0;               // who walk to and fro across it
  bool odometry = false;
  double odometryNoise = 0.01;  // share of each movement

  synthetic_world::CameraOptions camera;
  double cameraPitch = 8;  // degrees down
  synthetic_world::LidarOptions lidar;
  double turnTime = 0;  // s that the LiDAR turns for a scan
  synthetic_world::SensorNoise noise{0.01, 0};
  double labelNoise = 0;  // share of labels, of other kinds than points
  label_noise::LabelNoise::Kind labelNoiseKind = label_noise::LabelNoise::Kind::Points;

  std::filesystem::path classes;  // table whose raw ids are the world's classes; empty: the world's

  Outputs outputs;

  explicit Cli(CLI::App& app);
  /** Brings the parsed noise to the sensors. */
  void complete();
  /** Meters along the route. */
  double placeAt(double time) const { return start + speed * time; }
  bool wantsCamera() const { return sensor != "lidar"; }
  bool wantsLidar() const { return sensor != "camera"; }
};

constexpr double kGreatestDepth = 65;  // m: depth images hold millimeters in 16 bits

OptionList driveOptions(Cli& cli) {
  OptionList list;
  list.add("seed", cli.seed, "", "seed of the world and of all noise");
  list.add("hills", cli.hills, "", between(0, 2), "factor of the ground's heights; 0 is flat");
  list.add("rate", cli.rate, "", above(0), "frames a second");
  list.add("speed", cli.speed, "m/s", above(0), "speed of the robot");
  list.add("start", cli.start, "m", "where on the route to begin");
  list.add("people", cli.people, "", between(0, 1000),
           "people who walk to and fro across the route");
  list.add("odometry", cli.odometry, "",
           "write movements and sensory frames instead of observations with true poses");
  list.add("odometry_noise", cli.odometryNoise, "", between(0, 1),
           "standard deviation of a movement, as a share of it");
  return list;
}

OptionList sensorOptions(Cli& cli) {
  OptionList list;
  cli.camera.describe(list);
  list.remove("max_range");
  list.add("camera_pitch", cli.cameraPitch, "degrees", between(-80, 80),
           "how far the camera looks down");
  list.add("camera_range", cli.camera.maxRange, "m",
           above(synthetic_world::CameraOptions::kMinRange).upTo(kGreatestDepth),
           "greatest depth of the camera");
  cli.lidar.describe(list);
  for (const char* option : {"lowest", "highest", "max_range"}) list.remove(option);
  list.add("lidar_range", cli.lidar.maxRange, "m", above(synthetic_world::LidarOptions::kMinRange),
           "range of the LiDAR");
  list.add("turn_time", cli.turnTime, "s", between(0, 10),
           "time of a turn of the LiDAR, while the robot moves on; 0: all points at once");
  list.add("ghosts", cli.lidar.ghosts, "", between(0, 1),
           "share of the LiDAR's beams on windows, cars, water and signs that are reflected, and "
           "return from something else");
  cli.noise.describe(list);
  return list;
}

Cli::Cli(CLI::App& app) : outputs(app) {
  outputs.add(app, output, "FILE", "Rawlog to write")->required();
  addWords(app.add_option("--scene", scene, "Which world"), synthetic_world::sceneNames())
      ->capture_default_str();
  app.add_option("--frames", frames, "Number of frames; by default one round of the route")
      ->check(isNumber(between(1, 1000000)));
  addWords(app.add_option("--sensor", sensor, "Sensors of the robot"), {"camera", "lidar", "both"})
      ->capture_default_str();
  label_noise::addLabelNoiseKind(app, labelNoiseKind);
  app.add_option("--classes", classes,
                 "Class table (YAML) of the labels, whose raw ids are ids of the world's classes; "
                 "without: the world's own");
  ::addOptions(app, driveOptions(*this), "World and drive");
  ::addOptions(app, sensorOptions(*this), "Sensors");
}

void Cli::complete() {
  if (labelNoiseKind != label_noise::LabelNoise::Kind::Points)
    labelNoise = std::exchange(noise.label, 0);
  camera.noise = lidar.noise = noise;
}

/** The classes that things of the world have in the rawlog. */
class WorldClasses {
 public:
  /** \param file class table (YAML) whose raw ids are the world's classes; empty: the world's own
   * \throw std::runtime_error naming the file: it cannot be read, does not know a class of the
   * world, or has more classes than a camera's labels. */
  explicit WorldClasses(const std::filesystem::path& file)
      : m_table(file.empty() ? synthetic_world::classTable()
                             : semantic_types::loadClassTable(file)),
        m_ids{synthetic_world::kNoClass} {
    if (m_table.size() > kMostPixelClasses)
      throw std::runtime_error(file.string() + ": " + std::to_string(m_table.size()) +
                               " classes, and a pixel's labels hold 31");
    for (int id = 1; id <= synthetic_world::kClassCount; ++id) try {
        m_ids.push_back(m_table.fromRaw(static_cast<std::uint32_t>(id)));
      } catch (const std::invalid_argument& e) {
        throw std::runtime_error(file.string() + ": " + e.what());
      }
  }

  const synthetic_world::ClassTable& table() const { return m_table; }
  /** The world's become the rawlog's. */
  void translate(std::vector<ClassId>& labels) const {
    for (ClassId& id : labels) id = m_ids[id];
  }

 private:
  synthetic_world::ClassTable m_table;
  std::vector<ClassId> m_ids;  ///< by the world's
};

/** A pose in the format of the TUM data sets: time x y z qx qy qz qw. */
void writePose(std::ostream& out, double time, const mrpt::poses::CPose3D& T) {
  mrpt::math::CQuaternionDouble q;
  T.getAsQuaternion(q);
  out << std::fixed << std::setprecision(6) << time << std::setprecision(9);
  for (const double v : {T.x(), T.y(), T.z(), q.x(), q.y(), q.z(), q.r()}) out << ' ' << v;
  out << '\n';
}

/** Writes which world the rawlog shows: scene, seed, hills and classes, in YAML. */
void writeTruth(const Cli& cli, const WorldClasses& classes, int frames,
                const std::filesystem::path& file) {
  std::ostringstream out;
  out << "# The world that " << strict_files::printable(cli.output.filename().string())
      << " shows.\n"
      << "scene: " << cli.scene << "\nseed: " << cli.seed << "\nhills: " << cli.hills
      << "\nframes: " << frames << "\nlabel_noise: " << cli.noise.label << "\nclasses:\n";
  const synthetic_world::ClassTable& table = classes.table();
  for (ClassId id = 1; id <= table.size(); ++id) {
    const auto c = table.color(id);
    out << "  - {id: " << +id << ", name: " << strict_files::yamlText(table.name(id))
        << ", color: [" << +c.r << ", " << +c.g << ", " << +c.b << "]}\n";
  }
  strict_files::writeText(file, out.str());
}

constexpr double kStartTime = 1704067200;  // 2024-01-01, UTC

Eigen::Isometry3d T_robot_camera(double pitchDegrees) {
  return Eigen::Translation3d(0.25, 0, 1.4) *
         Eigen::AngleAxisd(pitchDegrees * M_PI / 180, Eigen::Vector3d::UnitY());
}

Eigen::Isometry3d T_robot_lidar() { return Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1.8)); }

std::filesystem::path beside(std::filesystem::path rawlog, const char* extension) {
  return rawlog.replace_extension(extension);
}

/** People who walk to and fro across the route, each from 4 m on its right to 6 m on its left. */
void walk(int people, double time, synthetic_world::Scene& scene) {
  constexpr double kRight = 4, kWay = 10, kSpeed = 1.2, kStep = 0.7;  // m, m/s
  const double walked = kSpeed * time, phase = std::fmod(walked, 2 * kWay);
  const bool isBack = phase > kWay;
  synthetic_world::Solids all;
  for (int i = 0; i < people; ++i) {
    const double s = (i + 0.5) * scene.route.length() / people;
    const Eigen::Vector2d at = scene.route.beside(s, (isBack ? 2 * kWay - phase : phase) - kRight);
    const double yaw = scene.route.heading(s) + (isBack ? -M_PI / 2 : M_PI / 2);
    for (auto& part :
         synthetic_world::person({at.x(), at.y(), scene.world.groundHeight(at.x(), at.y())}, yaw,
                                 {188, 62, 52}, walked / kStep))
      all.push_back(std::move(part));
  }
  scene.world.setMovables(std::move(all));
}

/** Wrong labels for the pixels of a camera. */
void disturb(synthetic_world::CameraFrame& frame, const synthetic_world::CameraOptions& camera,
             const Eigen::Isometry3d& T_world_camera, label_noise::LabelNoise& noise) {
  synthetic_world::LabeledCloud cloud;
  for (int row = 0; row < camera.height; ++row)
    for (int column = 0; column < camera.width; ++column)
      cloud.points.push_back((frame.depth.at(row, column) * camera.ray(row, column)).cast<float>());
  cloud.classes = std::move(frame.labels.pixels);
  noise.apply(cloud, T_world_camera);
  frame.labels.pixels = std::move(cloud.classes);
}

/** \param noise of labels; null: each sensor's own */
std::vector<mrpt::obs::CObservation::Ptr> sense(const Cli& cli, const WorldClasses& classes,
                                                const synthetic_world::Scene& scene,
                                                std::uint64_t frame,
                                                label_noise::LabelNoise* noise) {
  const double time = static_cast<double>(frame) / cli.rate;
  const Eigen::Isometry3d T_world_robot = scene.T_world_robot(cli.placeAt(time));
  std::vector<mrpt::obs::CObservation::Ptr> seen;
  if (cli.wantsCamera()) {
    const Eigen::Isometry3d mount = T_robot_camera(cli.cameraPitch);
    auto image = renderCamera(scene.world, T_world_robot * mount, cli.camera, {cli.seed, frame});
    classes.translate(image.labels.pixels);
    if (noise) disturb(image, cli.camera, T_world_robot * mount, *noise);
    seen.push_back(rangeScan(image, cli.camera, mount, classes.table()));
  }
  if (cli.wantsLidar()) {
    const Eigen::Isometry3d mount = T_robot_lidar();
    const auto path = [&](double share) {
      return scene.T_world_robot(cli.placeAt(time + share * cli.turnTime)) * mount;
    };
    auto cloud = scanLidar(scene.world, path, cli.lidar, {cli.seed, frame});
    classes.translate(cloud.classes);
    if (noise) noise->apply(cloud, T_world_robot * mount);
    const auto scan = labeledCloud(std::move(cloud), mount, classes.table());
    if (cli.turnTime > 0) scan->times = synthetic_world::sharesOfTurn(scan->cloud);
    for (float& share : scan->times) share *= static_cast<float>(cli.turnTime);
    seen.push_back(scan);
  }
  return seen;
}

void writeRawlog(const Cli& cli, const WorldClasses& classes, synthetic_world::Scene& scene) {
  const double duration = scene.route.length() / cli.speed;  // s, of one round
  const int frames = cli.frames > 0 ? cli.frames : static_cast<int>(std::ceil(duration * cli.rate));
  DriveLog rawlog(cli.output, cli.odometry, cli.odometryNoise, cli.seed);
  std::ostringstream trajectory;
  trajectory << "# time x y z qx qy qz qw (true poses of the robot)\n";
  std::optional<label_noise::LabelNoise> noise;
  if (cli.labelNoiseKind != label_noise::LabelNoise::Kind::Points)
    noise.emplace(cli.labelNoise, cli.labelNoiseKind, cli.seed, classes.table().size());
  const StopRequest stop("after this frame");
  std::optional<Progress> progress(std::in_place, "Driving", frames);
  int k = 0;
  for (; k < frames && !stop.pending(); ++k) {
    progress->update(k, std::to_string(k) + " frames");
    const double time = k / cli.rate;
    const Eigen::Isometry3d T_world_robot = scene.T_world_robot(cli.placeAt(time));
    walk(cli.people, time, scene);
    rawlog.write(
        mrpt::Clock::fromDouble(kStartTime + time), T_world_robot,
        sense(cli, classes, scene, static_cast<std::uint64_t>(k), noise ? &*noise : nullptr));
    writePose(trajectory, kStartTime + time, toMrpt(T_world_robot));
  }
  progress.reset();
  scene.world.setMovables({});
  rawlog.finish();
  strict_files::writeText(beside(cli.output, ".tum"), trajectory.str());
  writeTruth(cli, classes, k, beside(cli.output, ".truth.yaml"));
  notes() << cli.output.string() << ": " << k << " frames of " << cli.scene << ", "
          << cli.speed * k / cli.rate << " m of way\n";
}

int run(const Cli& cli) {
  cli.outputs.check({cli.output, beside(cli.output, ".tum"), beside(cli.output, ".truth.yaml")});
  const WorldClasses classes(cli.classes);
  synthetic_world::Scene scene = synthetic_world::makeScene(cli.scene, cli.seed, cli.hills);
  writeRawlog(cli, classes, scene);
  return 0;
}

}  // namespace

}  // namespace synth_rawlog

int main(int argc, char** argv) {
  CLI::App app(
      "Drives a labeled camera and a LiDAR through a synthetic world, and writes a rawlog");
  synth_rawlog::Cli cli(app);
  return runApplication(app, argc, argv, [&] {
    cli.complete();
    return synth_rawlog::run(cli);
  });
}
