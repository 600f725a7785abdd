// A robot drives from goal to goal through one village for hours of its time, with people and a map
// that forgets. Each tenth drive explores, and each scan's change of the compressed tree is told to
// a copy. What all this takes has to stay as it is: the program prints a table and fails where it
// does not.
//   long-run HOURS CONFIG ORDER [NOISE [SCENE SEED]]     e.g. long-run 24
//   test/long_run/robot.ini config/orders/synthetic.yaml 0.1 campus 7
#include <malloc.h>
#include <map_folders/MapFolder.h>
#include <map_streams/MapStream.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_planning/planner/OrderFile.h>
#include <synthetic_world/Objects.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>

#include "measuring/Measuring.h"
#include "simulated_drive/DriveLoop.h"

namespace {

using mrpt::math::TPose2D;
using semantic_octree::SemanticOcTree;
using simulated_drive::DriveLoop;

constexpr int kParts = 12;           // of the run, a row each
constexpr double kMayGrow = 1.1;     // most of the heap, from the first half to the second
constexpr double kGoalsWithin = 30;  // m around the world's middle
constexpr int kExploresEach = 10;    // drives

/** What the heap gave out and has not got back. */
double heapMegabytes() {
  const auto use = mallinfo2();
  return static_cast<double>(use.uordblks + use.hblkhd) / 1e6;
}

/** 0 of none. */
double quantile(const std::vector<double>& values, double share) {
  return values.empty() ? 0 : measuring::quantile(values, share);
}

/** Poses on ways, with room around them. */
class Goals {
 public:
  Goals(const synthetic_world::World& world, const synthetic_world::Footprint& footprint)
      : m_world(world), m_footprint(footprint), m_random(1) {}

  TPose2D next() {
    while (true) {
      const double heading = m_random.uniform(-M_PI, M_PI), y = along(), x = along();
      const TPose2D pose(x, y, heading);
      const auto ground = m_world.groundClass(pose.x, pose.y);
      const bool isWay = ground >= 1 && ground <= 4;  // road, markings, sidewalk, gravel
      if (isWay && m_world.clearance(m_footprint, pose.x, pose.y, pose.phi) > 1) return pose;
    }
  }

 private:
  double along() { return m_random.uniform(-kGoalsWithin, kGoalsWithin); }

  const synthetic_world::World& m_world;
  synthetic_world::Footprint m_footprint;
  synthetic_world::Random m_random;
};

/** Somebody walks from one way to another each half minute, and is gone when he is there. Now and
 * then he appears where the robot is: contacts are no faults of this program's. */
simulated_drive::Events people(Goals& goals, double seconds) {
  simulated_drive::Events events;
  for (double begin = 0; begin < seconds; begin += 30) {
    const TPose2D from = goals.next(), to = goals.next();
    simulated_drive::Events::Person person{begin, 0, {from.x, from.y}, {to.x, to.y}};
    person.end = begin + std::min(60.0, (person.to - person.from).norm() / person.speed);
    events.persons.push_back(person);
  }
  return events;
}

/** Tells a copy what becomes of the compressed tree, as a robot tells other ones. */
class Radio : public simulated_drive::DriveObserver {
 public:
  explicit Radio(SemanticOcTree& map) : m_broadcast(map, 1) {}

  void onSensed(const DriveLoop& loop, const std::vector<simulated_drive::Observation>&) override {
    loop.mapper();  // waits for the scan
    const std::string change = m_broadcast.change();
    m_bytes += change.size();
    if (!change.empty()) m_copy.accept(change);
  }
  bool isTheTree(const SemanticOcTree& compressed) const {
    return m_copy.isCurrent() && m_copy.map() == compressed;
  }
  double megabytes() const { return static_cast<double>(m_bytes) / 1e6; }

 private:
  semantic_octree::TreeBroadcast m_broadcast;
  semantic_octree::TreeCopy m_copy;
  std::size_t m_bytes = 0;
};

/** Where this process puts what it needs for a while; goes with what is left. */
class Scratch {
 public:
  Scratch() { setenv("TMPDIR", m_folder.c_str(), 1); }
  ~Scratch() { std::filesystem::remove_all(m_folder); }
  bool isEmpty() const { return std::filesystem::is_empty(m_folder); }

 private:
  std::string m_folder =
      mkdtemp((std::filesystem::temp_directory_path() / "XXXXXX").string().data());
};

/** A row of the table. */
struct Part {
  int drives = 0, arrived = 0, collisions = 0;
  double meters = 0, off = 0, heap = 0;
  std::size_t nodes = 0;
  std::vector<double> insert, replan;

  void add(const simulated_drive::DriveRecord& record) {
    ++drives;
    arrived += record.arrived();
    collisions += record.collisions;
    meters += record.length;
    for (const auto& row : record.rows)
      off = std::max(off, std::hypot(row.pose.x - row.believed.x, row.pose.y - row.believed.y));
    const auto take = [&](const char* stage, std::vector<double>& to) {
      const auto at = record.times.find(stage);
      if (at != record.times.end()) to.insert(to.end(), at->second.begin(), at->second.end());
    };
    take("insert", insert);
    take("replan", replan);
  }
  void print(double hours) const {
    std::printf("%7.2f %7d %8d %9d %8.0f %6.2f %9.1f %9zu %7.1f %7.1f %7.1f %7.1f\n", hours, drives,
                arrived, collisions, meters, off, heap, nodes, quantile(insert, 0.5),
                quantile(insert, 0.95), quantile(replan, 0.5), quantile(replan, 0.95));
    std::fflush(stdout);
  }
};

/** So that the drive can be looked at. */
void tellHowItEnded(const DriveLoop& loop) {
  const auto& record = loop.record();
  std::printf("%.0f s: from %s to %s: %s, %s\n", loop.time(), loop.start().asString().c_str(),
              loop.goal().asString().c_str(), simulated_drive::nameOf(record.end),
              record.reason.c_str());
}

bool isAsMadeAnew(const SemanticOcTree& map) {
  SemanticOcTree copy = map, anew = map;
  const auto options = semantic_octree::Abstraction(copy).options();
  dropAbstraction(anew);
  setAbstraction(anew, options);
  return anew == map;
}

int run(double hours, const char* configFile, const char* orderFile, double noise,
        const char* sceneName, std::uint64_t seed) {
  auto config = simulated_drive::loadDriveConfig(configFile);
  config.pose.odometryNoise = noise;
  config.pose.turnNoise = 30 * noise;
  auto scene = synthetic_world::makeScene(sceneName, seed);
  const auto order = semantic_planning::loadClassOrder(orderFile, synthetic_world::classTable());
  Goals goals(scene.world, simulated_drive::trueFootprint(config.planner.vehicle));
  const double seconds = hours * 3600;
  const TPose2D start = goals.next();
  auto stored = std::make_unique<semantic_octree::StoredMap>(
      SemanticOcTree(config.voxelSize, synthetic_world::classTable(), config.filter));
  SemanticOcTree& map = stored->tree();
  DriveLoop loop(config, scene.world, order, start, goals.next(), people(goals, seconds),
                 std::move(stored));
  Radio radio(map);
  loop.addObserver(radio);
  std::printf(
      "  hours  drives  arrived  contacts   meters  off m   heap MB     nodes  insert    95 %%  "
      "replan    "
      "95 %%\n");
  std::vector<double> heap;
  for (int i = 1, drives = 0; i <= kParts; ++i) {
    Part part;
    do {
      const bool explores = ++drives % kExploresEach == 0;
      if (explores) loop.explore(semantic_octree::Abstraction(map).options().weights);
      part.add(loop.run());
      if (!explores && !loop.record().arrived()) tellHowItEnded(loop);
      loop.goOn(goals.next());
    } while (loop.time() < seconds * i / kParts);
    part.nodes = loop.mapper().map().size();
    part.heap = heapMegabytes();
    heap.push_back(part.heap);
    part.print(loop.time() / 3600);
  }
  const bool isEqual = isAsMadeAnew(loop.mapper().map());
  const bool isCopied = radio.isTheTree(semantic_octree::Abstraction(map).compressedMap());
  const auto middle = heap.begin() + kParts / 2;
  const double growth =
      *std::max_element(middle, heap.end()) / *std::max_element(heap.begin(), middle);
  std::cout << "The G-values are " << (isEqual ? "" : "NOT ") << "those of the map made anew.\n"
            << "The copy, told of with " << radio.megabytes() << " MB, is "
            << (isCopied ? "" : "NOT ") << "the compressed tree.\n"
            << "The heap's most grew from the first half to the second by " << 100 * (growth - 1)
            << " %.\n";
  return isEqual && isCopied && growth <= kMayGrow ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 4)
      throw std::invalid_argument("usage: long-run HOURS CONFIG ORDER [NOISE [SCENE SEED]]");
    const Scratch scratch;
    const int status = run(std::atof(argv[1]), argv[2], argv[3], argc > 4 ? std::atof(argv[4]) : 0,
                           argc > 6 ? argv[5] : "village", argc > 6 ? std::atoll(argv[6]) : 1);
    std::cout << (scratch.isEmpty() ? "No file is left.\n" : "Files are LEFT.\n");
    return scratch.isEmpty() ? status : 1;
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 1;
  }
}
