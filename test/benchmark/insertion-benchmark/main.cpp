// Measures the insertion of labeled scans, next to other maps, in one run.
#include <labeled_cloud/Rawlogs.h>
#include <labeled_cloud/ScanConverter.h>
#include <labeled_cloud/Trajectory.h>
#include <malloc.h>
#include <semantic_types/ClassTable.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <stdexcept>

#include "Application.h"
#include "Runner.h"
#include "measuring/Measuring.h"

namespace insertion_benchmark {
namespace {

using semantic_octree::InsertionOptions;

struct Cli {
  std::filesystem::path rawlog, classes;
  Settings settings;
  std::size_t scans = 0;
  int repeats = 3;
  std::string only;

  explicit Cli(CLI::App& app) {
    app.add_option("RAWLOG", rawlog, "Rawlog with labels and poses of the robot")->required();
    app.add_option("--classes", classes, "Class table (YAML)")->required();
    addNumber(app, "--resolution", settings.resolution, strict_files::above(0),
              "Edge of a voxel, m");
    addNumber(app, "--range", settings.maxRange, strict_files::atLeast(0),
              "Maximum range, m; 0: none");
    app.add_option("--scans", scans, "Number of scans; 0: all")->capture_default_str();
    addChoice(app.add_option(
                  "--rays", settings.rays,
                  "Beams that this project's map casts: all, or one a voxel that beams end in"),
              std::map<std::string, InsertionOptions::Rays>{
                  {"all", InsertionOptions::Rays::All},
                  {"endpoints", InsertionOptions::Rays::EndVoxels}});
    addNumber(app, "--terms", settings.terms, strict_files::between(1, 8),
              "Classes whose information the compressed tree keeps, each with its G-values");
    addNumber(app, "--threads", settings.threads, strict_files::between(1, 256),
              "Threads of this project's map");
    addNumber(app, "--repeats", repeats, strict_files::between(1, 1000),
              "Measurements of each runner");
    app.add_option("--only", only,
                   "Measure only runners whose names contain this, and the bare traversal")
        ->type_name("NAME");
  }
};

Scene sceneOf(const Cli& cli) {
  const semantic_types::ClassTable table = semantic_types::loadClassTable(cli.classes);
  const labeled_cloud::Trajectory trajectory = labeled_cloud::readTrajectory({cli.rawlog});
  labeled_cloud::ScanConverter converter(table);
  labeled_cloud::RawlogReader reader(cli.rawlog);
  Scene scene;
  scene.numClasses = table.size();
  while (const auto entry = reader.next())
    for (const auto& observation : entry->observations) {
      if (cli.scans > 0 && scene.scans.size() == cli.scans) return scene;
      const auto T_map_robot = trajectory.at(observation->timestamp);
      if (!T_map_robot || !labeled_cloud::ScanConverter::accepts(*observation)) continue;
      const auto scan = converter.convert(*observation);
      scene.scans.push_back(
          {scan->cloud, labeled_cloud::toEigen(*T_map_robot + scan->T_robot_sensor)});
    }
  if (scene.scans.empty()) throw std::runtime_error(cli.rawlog.string() + ": no scans");
  return scene;
}

/** Bytes of this process: VmRSS, what it has, or VmHWM, the most it had. */
double memory(const std::string& entry) {
  std::ifstream in("/proc/self/status");
  double kilobytes = 0;
  for (std::string word; in >> word;)
    if (word == entry + ":") in >> kilobytes;
  return kilobytes * 1024;
}

/** What one turn takes, in which a runner inserts all scans. Milliseconds are medians over scans.
 */
struct Figures {
  double cpu = 0, cpu95 = 0, wall = 0;
  double mapBytes = 0;   ///< resident memory after the last scan, less that before the first
  double peakBytes = 0;  ///< the most meanwhile
  double touchedVoxels = 0;
};

Figures takeTurn(MakeRunner make, const Scene& scene, const Settings& settings) {
  using namespace measuring;
  const Runner runner = make(scene, settings);
  malloc_trim(0);
  const double before = memory("VmRSS");
  std::ofstream("/proc/self/clear_refs") << 5;  // the peak begins anew
  std::vector<double> cpu, wall;
  for (std::size_t i = 0; i < scene.scans.size(); ++i) {
    const Stopwatch processor(TimeOf::Process), clock;
    runner.insert(i);
    wall.push_back(clock.milliseconds());
    cpu.push_back(processor.milliseconds());
  }
  Figures f;
  f.peakBytes = memory("VmHWM") - before;
  malloc_trim(0);
  f.mapBytes = memory("VmRSS") - before;
  f.cpu = quantile(cpu, 0.5), f.cpu95 = quantile(cpu, 0.95), f.wall = quantile(wall, 0.5);
  f.touchedVoxels = static_cast<double>(runner.touchedVoxels());
  return f;
}

/** Memory that a child shares with its parent. */
Figures* sharedFigures() {
  void* const shared =
      mmap(nullptr, sizeof(Figures), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) throw std::runtime_error("no memory to share with a child process");
  return static_cast<Figures*>(shared);
}

/** A turn in a process of its own, whose memory is measured. */
Figures measure(const std::string& name, MakeRunner make, const Scene& scene,
                const Settings& settings) {
  static Figures* const shared = sharedFigures();
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no child process");
  if (child == 0) {
    try {
      *shared = takeTurn(make, scene, settings);
      _exit(0);
    } catch (const std::exception& e) {
      std::cerr << name << ": " << e.what() << std::endl;
      _exit(1);
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (status != 0) throw std::runtime_error(name + " did not come to its end");
  return *shared;
}

/** The median over the turns. */
double median(const std::vector<Figures>& turns, double Figures::*figure) {
  std::vector<double> values;
  for (const Figures& turn : turns) values.push_back(turn.*figure);
  return measuring::quantile(values, 0.5);
}

/** (largest - smallest) / median of the turns, %. */
double spread(const std::vector<Figures>& turns) {
  const auto [least, most] = std::minmax_element(
      turns.begin(), turns.end(), [](const Figures& a, const Figures& b) { return a.cpu < b.cpu; });
  return 100 * (most->cpu - least->cpu) / median(turns, &Figures::cpu);
}

void printHeading(const Cli& cli, const Scene& scene) {
  std::size_t points = 0;
  for (const PosedScan& scan : scene.scans) points += scan.cloud.size();
  double load = 0;
  getloadavg(&load, 1);
  const Settings& s = cli.settings;
  std::cout << cli.rawlog.filename().string() << ": " << scene.scans.size() << " scans, " << points
            << " points; resolution " << s.resolution << " m, range " << s.maxRange << " m, rays "
            << (s.rays == InsertionOptions::Rays::All ? "all" : "endpoints") << ", " << s.threads
            << " thread(s), " << s.terms << " terms, " << cli.repeats << " repeats, load average "
            << load << "\n\n"
            << std::left << std::setw(30) << "CPU and wall: ms per scan" << std::right;
  for (const char* column :
       {"CPU", "spread %", "95 %", "wall", "traversals", "bytes/voxel", "peak MB"})
    std::cout << std::setw(12) << column;
  std::cout << '\n' << std::fixed;
}

void printRow(const std::string& name, const std::vector<Figures>& turns,
              const Figures& traversal) {
  std::cout << std::left << std::setw(30) << name << std::right << std::setprecision(2);
  for (const double number :
       {median(turns, &Figures::cpu), spread(turns), median(turns, &Figures::cpu95),
        median(turns, &Figures::wall), median(turns, &Figures::cpu) / traversal.cpu,
        turns.back().mapBytes / traversal.touchedVoxels, turns.back().peakBytes / 1e6})
    std::cout << std::setw(12) << number;
  std::cout << '\n';
}

int run(const Cli& cli) {
  const Scene scene = sceneOf(cli);
  printHeading(cli, scene);
  std::cout.flush();
  std::map<std::string, std::vector<Figures>> turns;
  for (int repeat = 0; repeat < cli.repeats; ++repeat)
    for (const auto& [name, make] : runners())
      if (name == kTraversal || name.find(cli.only) != std::string::npos)
        turns[name].push_back(measure(name, make, scene, cli.settings));
  Figures traversal = turns[kTraversal].back();
  traversal.cpu = median(turns[kTraversal], &Figures::cpu);
  for (const auto& [name, make] : runners())
    if (turns.count(name)) printRow(name, turns[name], traversal);
  return 0;
}

}  // namespace
}  // namespace insertion_benchmark

int main(int argc, char** argv) {
  CLI::App app("Measures the insertion of labeled scans, next to other maps, in one run");
  insertion_benchmark::Cli cli(app);
  return runApplication(app, argc, argv, [&] { return insertion_benchmark::run(cli); });
}
