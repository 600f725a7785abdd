// Drives a robot through a synthetic world: it maps, compresses, plans and drives.
#include <map_folders/MapFolder.h>
#include <map_pictures/PictureFiles.h>
#include <mrpt/math/TPose2D.h>
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_octree/TreeFile.h>
#include <semantic_planning/planner/OrderFile.h>
#include <strict_files/OutputFiles.h>
#include <strict_files/TextFile.h>
#include <synthetic_world/Scene.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <filesystem>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

#include "Application.h"
#include "DriveViews.h"
#include "inputs/Inputs.h"
#include "poses/Poses.h"
#include "simulated_drive/DriveLoop.h"
#include "synthetic_rawlog/Observations.h"

namespace semantic_map_drive {
namespace {
using namespace simulated_drive;

namespace fs = std::filesystem;

/** What the command line says. */
struct Cli {
  std::filesystem::path map, order, config, output;
  std::filesystem::path weights;  ///< of what is explored for; empty: for whatever is unknown
  std::string solution;
  std::string scene = "village";
  std::uint64_t seed = 1;
  double hills = 1, memory = semantic_octree::MapFolderOptions().memory;
  mrpt::math::TPose2D start, goal;
  bool rawlog = true, pictures = true, navlog = false, live = false;
  bool explore = false;
  Events events;
  Outputs outputs;

  explicit Cli(CLI::App& app);

 private:
  void addEvents(CLI::App& app);
};

Cli::Cli(CLI::App& app) : outputs(app) {
  addWords(app.add_option("--scene,--world", scene, "Which synthetic world"),
           synthetic_world::sceneNames())
      ->capture_default_str();
  app.add_option("--seed", seed, "Seed of the world and of all noise")->capture_default_str();
  addNumber(app, "--hills", hills, strict_files::between(0.0, 2.0),
            "Factor of the ground's heights; 0 is flat");
  app.add_option("--map", map,
                 std::string("Map that the robot begins with, which stays as it is (") +
                     inputs::kMap + "); without: none");
  addMemoryOption(app, memory);
  poses::addPose(app, "--start", start, "Where the robot is")->required();
  CLI::Option_group* where = app.add_option_group("Where to");
  poses::addPose(*where, "--goal", goal, "Where the robot shall go");
  CLI::Option* exploring =
      where->add_flag("--explore", explore,
                      "Instead of a goal: look around until what is left is not worth the way");
  where->require_option(1);
  app.add_option("--weights", weights,
                 "Weights of the classes to explore for (YAML, see config/weights)")
      ->needs(exploring);
  app.add_option("--solution", solution, "Name of one solution in the weights; without: the first")
      ->type_name("NAME")
      ->needs("--weights");
  app.add_option("--order", order, "Classes from best to worst (YAML)")->required();
  app.add_option("--config", config, "Robot, sensors, planner (.ini, see config/drives)")
      ->required();
  outputs.add(app, output, "FOLDER", "Folder of the results, created if need be")->required();
  addEvents(app);
  app.add_flag("!--no-rawlog", rawlog, "Write no rawlog");
  app.add_flag("--navlog", navlog, "Write drive.reactivenavlog, for MRPT's navlog-viewer");
  app.add_flag("--live", live,
               "Show the drive in a window, no faster than real time, until the window is closed");
  app.add_flag("!--no-pictures", pictures, "Write no animation");
}

void Cli::addEvents(CLI::App& app) {
  const auto add = [&app](const char* name, const char* type, auto take, const char* help) {
    poses::addParsed(app, name, type, take, help)->expected(1, -1);  // one or more
  };
  add(
      "--person", "T,X,Y,X2,Y2[,T2]", [this](auto& t) { events.persons.push_back(parsePerson(t)); },
      "Somebody walks from one place to another, from second T on, and is gone at T2");
  add(
      "--roadblock", "T,X,Y,DEG,LENGTH",
      [this](auto& t) { events.roadblocks.push_back(parseRoadblock(t)); },
      "A barrier across a way, from second T on");
  add(
      "--sensor-dropout", "T,T2", [this](auto& t) { events.dropouts.push_back(parseSpan(t)); },
      "The sensors see nothing from second T to T2");
}

/** Writes what the robot saw, and its true poses, as a rawlog. */
class Recorder : public DriveObserver {
 public:
  /** \throw std::runtime_error the file cannot be written. */
  explicit Recorder(const std::filesystem::path& file) : m_log(file, false, 0, 0) {}

  void onSensed(const DriveLoop& loop, const std::vector<Observation>& seen) override {
    std::vector<mrpt::obs::CObservation::Ptr> originals;
    for (const Observation& o : seen) originals.push_back(o.original);
    m_log.write(mrpt::Clock::now(), loop.T_world_robot(), originals);
  }
  void onFinished(const DriveLoop&) override { m_log.finish(); }

 private:
  synthetic_rawlog::DriveLog m_log;
};

/** A picture of each second of the drive, and one of its end. Exploring takes long: its animation
 * takes 20 s if it needs all of its time. */
class Animation : public DriveObserver {
 public:
  Animation(DrivePicture& picture, DriveLoop& loop, const fs::path& file)
      : m_picture(picture),
        m_loop(loop),
        m_period(loop.explores() ? std::max(1.0, loop.config().timeLimit / 98) : 1),
        m_gif(file, loop.explores() ? 0.2 : 0.12) {}

  void onSensed(const DriveLoop& loop, const std::vector<Observation>&) override {
    if (loop.time() < m_next - 1e-6) return;
    m_next += m_period;
    m_gif.add(m_picture.frame(m_loop));
  }
  void onFinished(const DriveLoop&) override {
    m_gif.add(m_picture.frame(m_loop));
    m_gif.close();
  }

 private:
  DrivePicture& m_picture;
  DriveLoop& m_loop;
  double m_period;  ///< s
  map_pictures::GifFile m_gif;
  double m_next = 0;  ///< s
};

constexpr int kNotArrived = 2;  // exit status
const std::vector<std::string> kFiles = {"drive.csv", "drive.json",          "drive.png",
                                         "drive.gif", "drive.rawlog",        "map.semantic",
                                         "left.png",  "drive.reactivenavlog"};

void printSummary(const DriveRecord& record) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << nameOf(record.end) << " after " << record.duration()
       << " s and " << record.length << " m; replans: " << record.replans
       << ", collisions: " << record.collisions << ", least clearance: " << std::setprecision(2)
       << record.leastClearance << " m; " << std::lround(100 * shareOfSlowCycles(record))
       << " % of cycles took more than 100 ms\n";
  notes() << text.str();
  if (!record.reason.empty()) notes() << record.reason << '\n';
}

/** The world and what is known of it, and the drive in it. */
class DriveProgram {
 public:
  explicit DriveProgram(const Cli& cli)
      : m_cli(checked(cli)),
        m_config(loadDriveConfig(cli.config)),
        m_weights(weightsOf(cli)),
        m_scene(sceneOf(cli)),
        m_output(cli.output),
        m_picture(regionOf(cli, m_scene.world), cli.explore ? 640 : 960, cli.explore) {
    m_config.sensors.seed = cli.seed;
  }

  int run() {
    const DriveRecord record = drive();
    if (m_cli.navlog)
      fs::rename(navlogs() / "log_000.reactivenavlog", m_output.staged("drive.reactivenavlog"));
    m_output.commit(kFiles);
    if (m_window) m_window->stay();
    return record.arrived() || record.end == DriveEnd::Explored ? 0 : kNotArrived;
  }

 private:
  /** MRPT gives its logs names of its own, and finishes them when the drive is gone. */
  fs::path navlogs() const { return m_output.staged("navlogs"); }

  /** What the robot knows. Tiles of a folder that the drive changes are kept apart. */
  std::unique_ptr<semantic_octree::StoredMap> known() const {
    if (m_cli.map.empty()) return nullptr;
    if (auto octomap = inputs::octomapIn(m_cli.map))
      return std::make_unique<semantic_octree::StoredMap>(std::move(*octomap));
    semantic_octree::MapFolderOptions options;
    options.memory = m_cli.memory;
    options.draft = m_output.staged("tiles");
    return std::make_unique<semantic_octree::StoredMap>(m_cli.map, options);
  }

  DriveRecord drive() {
    const auto order =
        semantic_planning::loadClassOrder(m_cli.order, synthetic_world::classTable());
    DriveLoop& loop = m_loop.emplace(m_config, m_scene.world, order, m_cli.start, goalOf(m_cli),
                                     m_cli.events, known(), m_cli.navlog ? navlogs() : fs::path());
    if (m_cli.explore) loop.explore(m_weights);
    std::optional<Recorder> recorder;
    if (m_cli.rawlog) {
      loop.keepOriginals();
      loop.addObserver(recorder.emplace(m_output.staged("drive.rawlog")));
    }
    std::optional<Animation> animation;
    if (m_cli.pictures)
      loop.addObserver(animation.emplace(m_picture, loop, m_output.staged("drive.gif")));
    if (m_cli.live) {
      loop.keepOriginals();
      loop.addObserver(m_window.emplace(loop, m_scene.world, m_cli.start, goalOf(m_cli)));
      m_window->stopWhen([this] { return m_stop.pending(); });
    }
    const DriveRecord record = run(loop);
    strict_files::writeText(m_output.staged("drive.csv"), toCsv(record));
    writeJson(m_output.staged("drive.json"), toJson(record, order));
    semantic_octree::saveTree(loop.mapper().map(), m_output.staged("map.semantic").string());
    if (m_cli.explore)
      save(DrivePicture(regionOf(m_cli, m_scene.world), 1200, true).draw(loop), "left.png");
    DrivePicture whole(regionOf(m_cli, m_scene.world), 1200, false);
    whole.include(record);
    save(whole.draw(loop), "drive.png");
    printSummary(record);
    if (!m_window) m_loop.reset();
    return record;
  }

  DriveRecord run(DriveLoop& loop) const {
    Progress progress("Driving", 0);
    loop.stopWhen([&] {
      progress.update(0, std::to_string(std::lround(loop.time())) + " s of the drive");
      return m_stop.pending();
    });
    return loop.run();
  }

  void save(const map_pictures::MapCanvas& canvas, const std::string& name) const {
    map_pictures::savePicture(map_pictures::withTitle(canvas.sheet(), caption(*m_loop)),
                              m_output.staged(name));
  }

  /** Nobody knows where it goes to look around. */
  static Eigen::AlignedBox2d regionOf(const Cli& cli, const synthetic_world::World& world) {
    constexpr double kRoom = 12;  // m
    if (cli.explore) return around({0, 0, 0}, world.terrain().halfExtent());
    return around(cli.start, kRoom).merged(around(cli.goal, kRoom));
  }
  static mrpt::math::TPose2D goalOf(const Cli& cli) { return cli.explore ? cli.start : cli.goal; }
  static std::optional<tree_abstraction::AbstractionWeights> weightsOf(const Cli& cli) {
    if (cli.weights.empty()) return {};
    return semantic_octree::loadSolution(cli.weights, cli.solution, synthetic_world::classTable())
        .weights;
  }
  /** Start and goal lie in it. */
  static synthetic_world::Scene sceneOf(const Cli& cli) {
    synthetic_world::Scene scene = synthetic_world::makeScene(cli.scene, cli.seed, cli.hills);
    const double end = scene.world.terrain().halfExtent();
    for (const auto& [name, place] : {std::pair("--start", cli.start), {"--goal", goalOf(cli)}})
      if (std::max(std::abs(place.x), std::abs(place.y)) > end)
        throw std::runtime_error(std::string(name) + ": outside of the world, where x and y are " +
                                 strict_files::textOf(-end) + " to " + strict_files::textOf(end) +
                                 " m");
    return scene;
  }
  static const Cli& checked(const Cli& cli) {
    cli.outputs.checkFolder(cli.output, kFiles);
    if (cli.live && semantic_octree::MapFolder::isAt(cli.map))
      throw std::runtime_error("--live: a map in a folder of tiles is not shown");
    return cli;
  }

  const StopRequest m_stop{"after this step of the control"};
  const Cli& m_cli;
  DriveConfig m_config;
  const std::optional<tree_abstraction::AbstractionWeights> m_weights;  ///< explored for
  synthetic_world::Scene m_scene;
  strict_files::OutputFolder m_output;
  DrivePicture m_picture;           ///< on the way
  std::optional<DriveLoop> m_loop;  ///< as long as the window shows it
  std::optional<LiveWindow> m_window;
};

}  // namespace

}  // namespace semantic_map_drive

int main(int argc, char** argv) {
  CLI::App app("Drives a robot through a synthetic world; it maps, plans and drives");
  const semantic_map_drive::Cli cli(app);
  return runApplication(app, argc, argv,
                        [&] { return semantic_map_drive::DriveProgram(cli).run(); });
}
