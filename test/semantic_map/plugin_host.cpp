// A program that knows MRPT but nothing of this project. `plugin_host [PLUGIN.so]` makes a map by
// its name, fills it, copies it through an archive, and prints it. `plugin_host PLUGIN.so FILE.ini
// PREFIX` makes that of the file, drives there and back, prints the likelihood of what it sees on
// the way, and saves the map.
#include <dlfcn.h>
#include <mrpt/config/CConfigFile.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/rtti/CObject.h>

#include <cmath>
#include <iostream>

namespace {

/** A sphere of 12 m around the robot. */
mrpt::obs::CObservationPointCloud sphere() {
  constexpr int kPoints = 30000;
  const auto points = mrpt::maps::CSimplePointsMap::Create();
  for (int i = 0; i < kPoints; ++i) {  // Fibonacci's
    const double z = 1 - (2 * i + 1.0) / kPoints, r = 12 * std::sqrt(1 - z * z), angle = 2.4 * i;
    points->insertPoint(float(r * std::cos(angle)), float(r * std::sin(angle)), float(12 * z));
  }
  mrpt::obs::CObservationPointCloud observation;
  observation.pointcloud = points;
  return observation;
}

double drive(mrpt::maps::CMultiMetricMap& maps) {
  const auto seen = sphere();
  const auto pose = [](int i) { return mrpt::poses::CPose3D(15.1 * i, 0.3 * i, 0, 0, 0, 0); };
  double likelihood = 0;
  constexpr int kStops = 40;
  for (int i = 0; i < kStops; ++i) {
    if (!maps.insertObservation(seen, pose(i))) throw std::runtime_error("observation refused");
    likelihood += maps.computeObservationLikelihood(seen, pose(i));
  }
  for (int i = kStops - 1; i >= 0; --i)
    likelihood += maps.computeObservationLikelihood(seen, pose(i));
  return likelihood;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc > 1 && !dlopen(argv[1], RTLD_NOW)) throw std::runtime_error(dlerror());

  mrpt::maps::TSetOfMetricMapInitializers definitions;
  if (argc > 3) {
    definitions.loadFromConfigFile(mrpt::config::CConfigFile(argv[2]), "M");
    mrpt::maps::CMultiMetricMap maps(definitions);
    std::cout.precision(17);
    std::cout << drive(maps) << "\n";
    maps.saveMetricMapRepresentationToFile(argv[3]);
    return 0;
  }
  definitions.loadFromConfigFile(
      mrpt::config::CConfigFileMemory(std::string("[M]\nsemanticOctoMap_count = 1\n")), "M");
  mrpt::maps::CMultiMetricMap maps(definitions);
  if (maps.maps.empty()) throw std::runtime_error("no map of that name");

  mrpt::obs::CObservationPointCloud observation;
  const auto points = mrpt::maps::CSimplePointsMap::Create();
  points->insertPoint(1, 2, 3);
  observation.pointcloud = points;
  if (!maps.insertObservation(observation)) throw std::runtime_error("observation refused");
  const mrpt::maps::CMultiMetricMap copy = maps;
  std::cout << copy.maps.at(0)->GetRuntimeClass()->className
            << (copy.isEmpty() ? " is empty" : " is filled") << "\n";
  if (!mrpt::rtti::findRegisteredClass("labeled_cloud::CObservationLabeledCloud"))
    throw std::runtime_error("the observation is not registered");
} catch (const std::exception& e) {
  std::cerr << e.what() << "\n";
  return 1;
}
