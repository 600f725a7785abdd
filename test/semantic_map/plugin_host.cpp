// A program that knows MRPT but nothing of this project. `plugin_host [PLUGIN.so]` makes a map by
// its name, fills it, copies it, and prints it.
#include <dlfcn.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/rtti/CObject.h>

#include <iostream>

int main(int argc, char** argv) try {
  if (argc > 1 && !dlopen(argv[1], RTLD_NOW)) throw std::runtime_error(dlerror());

  mrpt::maps::TSetOfMetricMapInitializers definitions;
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
