// A city: synthetic scenes with different seeds side by side, a LiDAR that drives through them one
// after the other, mapped into a folder under a budget.
//     city_benchmark FOLDER SCENES_IN_A_ROW MEGABYTES [compress]
// Or one row of villages on a plain, whose roads make one:
//     city_benchmark FOLDER VILLAGES MEGABYTES road
#include <map_folders/MapFolder.h>
#include <map_operations/MapOperations.h>
#include <semantic_abstraction/Abstraction.h>
#include <synthetic_world/Scene.h>
#include <synthetic_world/Sensors.h>
#include <synthetic_world/Solids.h>
#include <sys/resource.h>

#include <chrono>
#include <iostream>
#include <random>

using namespace semantic_octree;

namespace {

constexpr double kSpacing = 160, kStep = 4;  // meters

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double processorSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

long peakMegabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1000;
}

struct Place {
  int row, column;
  Eigen::Translation3d offset() const { return {kSpacing * column, kSpacing * row, 0}; }
};

/** Calls f(cloud, T_scene_sensor) for each scan along a scene's route. */
template <typename F>
void scanAlong(const synthetic_world::Scene& scene, const F& f) {
  const synthetic_world::Drive robot(scene, 1);
  synthetic_world::LidarOptions lidar;
  lidar.columns = 512;
  lidar.noise.range = 0.01;
  lidar.noise.label = 0.1;
  const Eigen::Translation3d T_robot_lidar(0, 0, 1.8);
  std::uint64_t frame = 0;
  for (double s = 0; s < scene.route.length(); s += kStep) {
    const Eigen::Isometry3d T = robot.T_world_robot(s) * T_robot_lidar;
    f(scanLidar(scene.world, T, lidar, {scene.seed, ++frame}), T);
  }
}

/** Calls f(cloud, T_city_sensor) for each scan of the drive through a place's scene. */
template <typename F>
double drive(const Place& place, const F& f) {
  const auto names = synthetic_world::sceneNames();
  const auto seed = static_cast<std::uint64_t>(100 * place.row + place.column + 1);
  const synthetic_world::Scene scene = synthetic_world::makeScene(names[seed % names.size()], seed);
  scanAlong(scene, [&](const LabeledCloud& cloud, const Eigen::Isometry3d& T) {
    f(cloud, place.offset() * T);
  });
  return scene.route.length();
}

/** Where a village's road from the west meets that of the one before from the east. */
constexpr double kHalfVillage = 75, kShift = 40;

/** Without what is beyond the village, where the next one is. */
LabeledCloud within(const LabeledCloud& cloud, const Eigen::Isometry3d& T_village_sensor) {
  LabeledCloud inside;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3d p = T_village_sensor * cloud.points[i].cast<double>();
    if (std::abs(p.x()) > kHalfVillage) continue;
    inside.points.push_back(cloud.points[i]);
    inside.classes.push_back(cloud.classes[i]);
  }
  return inside;
}

/** Its ring of streets, and the road through it from west to east. */
template <typename F>
void driveThroughVillage(int number, const F& f) {
  constexpr double kPlain = 0, kRadius = 5;
  synthetic_world::Scene village =
      synthetic_world::makeScene("village", static_cast<std::uint64_t>(number) + 1, kPlain);
  const Eigen::Translation3d offset(2 * kHalfVillage * number, kShift * number, 0);
  const auto scan = [&](const LabeledCloud& cloud, const Eigen::Isometry3d& T) {
    f(within(cloud, T), offset * T);
  };
  scanAlong(village, scan);
  village.route = synthetic_world::Curve({{-kHalfVillage, -30},
                                          {-50, -26},
                                          {-30, -20.4},
                                          {4, -14},
                                          {42, -22},
                                          {41, 2},
                                          {58, 4},
                                          {kHalfVillage, 10}},
                                         kRadius);
  scanAlong(village, scan);
}

InsertionOptions insertion() {
  InsertionOptions options;
  options.maxRange = 30;
  return options;
}

SemanticOcTree emptyMap() { return {0.2, synthetic_world::classTable()}; }

AbstractionOptions abstraction() {
  AbstractionOptions options;
  options.weights.terms = {tree_abstraction::relevant("1", 1, {1}),
                           tree_abstraction::relevant("2", 0.5, {2})};
  options.weights.alpha = 0.02;
  return options;
}

/** The scenes from 2 to 4, and what of others is seen there, in a map of its own: it has to be the
 * same.
 */
bool samePiece(const SemanticOcTree& city) {
  SemanticOcTree whole = emptyMap();
  for (int row = 1; row < 5; ++row)
    for (int column = 1; column < 5; ++column)
      drive({row, column}, [&](const LabeledCloud& cloud, const Eigen::Isometry3d& T) {
        whole.insert(cloud, T, insertion());
      });
  const Eigen::AlignedBox3d box(Eigen::Vector3d(2 * kSpacing, 2 * kSpacing, -20),
                                Eigen::Vector3d(2 * kSpacing + 300, 2 * kSpacing + 300, 50));
  const SemanticOcTree piece = cropped(city, box);
  std::cout << "piece of 300 m: " << piece.getNumLeafNodes() << " leaves" << std::endl;
  return piece == cropped(whole, box);
}

void say(const MapFolder& tiles, const SemanticOcTree& map) {
  const auto c = tiles.contents();
  std::cout << "  tiles " << c.tiles << ", in memory " << c.tilesInMemory << ", came in "
            << c.broughtIn << ", went out " << c.sentOut << ", leaves " << map.getNumLeafNodes()
            << ", MB in memory " << map.memoryUsage() / 1000000 << ", peak of the process "
            << peakMegabytes() << " MB" << std::endl;
}

void run(const std::string& folder, int size, double memory, bool compress) {
  SemanticOcTree map = emptyMap();
  MapFolderOptions options;
  options.memory = memory;
  MapFolder tiles(map, folder, MapFolder::Access::Write, options);
  double meters = 0, inserting = 0;
  std::size_t scans = 0;
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column)
      meters += drive({row, column}, [&](const LabeledCloud& cloud, const Eigen::Isometry3d& T) {
        const double begin = processorSeconds();
        map.insert(cloud, T, insertion());
        inserting += processorSeconds() - begin;
        ++scans;
      });
    std::cout << "row " << row << ": " << meters / 1000 << " km, " << scans
              << " scans, inserted in " << inserting << " s of processor time" << std::endl;
    say(tiles, map);
  }
  double begin = seconds();
  tiles.save();
  std::cout << "saved in " << seconds() - begin << " s, " << tiles.contents().bytesOnDisk / 1000000
            << " MB" << std::endl;
  begin = seconds();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(0, kSpacing * (size - 1));
  constexpr int kQueries = 1000;
  std::size_t hits = 0;
  for (int i = 0; i < kQueries; ++i) {
    const double x = anywhere(random), y = anywhere(random);
    hits += map.castRay(octomap::point3d(float(x), float(y), 30), {0, 0, -1}).has_value();
  }
  std::cout << kQueries << " rays down at random places in " << seconds() - begin << " s, " << hits
            << " hits" << std::endl;
  say(tiles, map);
  if (compress) {
    begin = seconds();
    setAbstraction(map, abstraction());
    StoredMap compressed(Abstraction(map).emptyCompressedMap(), folder + "/compressed",
                         {memory / 10, options.tileSize});
    Abstraction(map).compressTo(compressed.tree());
    std::cout << "compressed in " << seconds() - begin
              << " s: " << compressed.tree().getNumLeafNodes() << " leaves" << std::endl;
    say(tiles, map);
  }
  if (size >= 5) std::cout << (samePiece(map) ? "same" : "NOT THE SAME") << std::endl;
}

void runRoad(const std::string& folder, int villages, double memory) {
  SemanticOcTree map = emptyMap();
  MapFolderOptions options;
  options.memory = memory;
  MapFolder tiles(map, folder, MapFolder::Access::Write, options);
  for (int number = 0; number < villages; ++number)
    driveThroughVillage(number, [&](const LabeledCloud& cloud, const Eigen::Isometry3d& T) {
      map.insert(cloud, T, insertion());
    });
  tiles.save();
  say(tiles, map);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 64;
  if (argc > 4 && argv[4] == std::string("road"))
    runRoad(argv[1], std::stoi(argv[2]), std::stod(argv[3]));
  else
    run(argv[1], std::stoi(argv[2]), std::stod(argv[3]), argc > 4);
  return 0;
}
