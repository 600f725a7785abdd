#include "OptionTables.h"

#include <labeled_cloud/CloudLabeler.h>
#include <labeled_cloud/LabelImage.h>
#include <labeled_cloud/NetworkLabeler.h>
#include <labeled_cloud/ScanStream.h>
#include <map_operations/SmoothedView.h>
#include <map_pictures/MapPictures.h>
#include <semantic_driving/DynamicObstacles.h>
#include <semantic_driving/ViewStrategy.h>
#include <semantic_map/MapOptions.h>
#include <semantic_planning/planner/SemanticPlanner.h>
#include <semantic_slam/SlamOptions.h>
#include <synthetic_world/Sensors.h>

#include <utility>

#include "semantic-map-ros2/Parameters.h"
#include "simulated_drive/DriveConfig.h"

using strict_files::Option;
using strict_files::OptionList;

namespace {

/** Adds the options of a struct at their defaults. */
template <class Options, class Describe>
void add(OptionTable& table, Describe describe) {
  const auto options = std::make_shared<Options>();
  describe(*options, table.list);
  table.owners.push_back(options);
}

template <class... Options>
OptionTable table(const std::string& title, const std::string& where) {
  OptionTable t{title, where, {}, {}};
  (add<Options>(t, [](Options& o, OptionList& list) { o.describe(list); }), ...);
  return t;
}

std::vector<OptionTable> mapTables() {
  using namespace semantic_map;
  OptionTable insertion = table<TInsertionOptions>(
      "Insertion",
      "`[insertion]`; `_insertOpts`, which has `kind` and `min_confidence` of [labels](#labels), "
      "too. `accuracy` and all behind it are the filter's: they are stored in the map, and only "
      "maps of the same filter can be merged; `semantic-map-info MAP --json` says what a map has.");
  for (const char* ofLabels : {"kind", "min_confidence"}) insertion.list.remove(ofLabels);
  return {
      table<TCreationOptions>("The map",
                              "`[map]` of `rawlog2semantic-map`; `_creationOpts` in MRPT's "
                              "applications."),
      insertion,
      table<TAbstractionOptions>(
          "Abstraction",
          "`[abstraction]`; `_abstractionOpts`. Files of weights for `semantic-map-compress` have "
          "the same options, with lists of their own for classes and `regions`: see [its "
          "page](../../apps/semantic-map-compress/README.md). How to choose: "
          "[compression](compression.md)."),
      table<TFolderOptions>("Maps in folders",
                            "`_folderOpts`. Of `rawlog2semantic-map`, `folder` is `--tiles`; other "
                            "programs that read "
                            "maps have `--memory`. See [large maps](large-maps.md)."),
      table<semantic_slam::SlamOptions>(
          "SLAM",
          "`[slam]` of `rawlog2semantic-map`, with `--slam`; of drives with noise in the pose."),
      table<semantic_octree::SmoothingOptions>(
          "Neighbors",
          "`semantic_octree::SmoothedView`, `semantic-map-export`, `semantic-map-evaluate`; these "
          "programs begin with a weight of 0. What it brings: "
          "[accuracy](../how-it-works/accuracy.md)."),
      table<map_pictures::PictureStyle, map_pictures::Viewpoint>(
          "Pictures", "`[pictures]` of `rawlog2semantic-map`."),
  };
}

std::vector<OptionTable> labelTables() {
  using namespace labeled_cloud;
  OptionTable input{"Networks: input", "Section `input` of a network's configuration.", {}, {}};
  add<NetworkOptions>(input, [](auto& o, OptionList& list) { o.describeInput(list); });
  OptionTable output{"Networks: output", "Section `output` of a network's configuration.", {}, {}};
  add<NetworkOptions>(output, [](auto& o, OptionList& list) { o.describeOutput(list); });
  return {
      table<LabelFolderOptions, LabelModel, ScanStreamOptions>(
          "Labels", "`[labels]` of `rawlog2semantic-map`."),
      table<CloudLabelerOptions>("Cameras that label the points of other sensors",
                                 "`[cameras]` of `rawlog2semantic-map`."),
      table<CameraDescription>(
          "Calibration of a camera",
          "`[camera NAME]` of `rawlog2semantic-map`, for the camera with this sensor label. The "
          "optics or the pose may be left out as a whole."),
      input,
      output,
  };
}

std::vector<OptionTable> simulationTables() {
  using namespace synthetic_world;
  using namespace simulated_drive;
  return {
      table<CameraOptions>("Synthetic cameras", "`synth-rawlog`, `semantic-map-drive`."),
      table<LidarOptions>("Synthetic LiDARs", "`synth-rawlog`, `semantic-map-drive`."),
      table<SensorConfig>("Simulated sensors", "`[sensors]`; `[camera]` and `[lidar]` are above."),
      table<PoseOptions>("Simulated odometry", "`[pose]`; it is corrected as `[slam]` says."),
  };
}

std::vector<OptionTable> planningTables() {
  using namespace semantic_planning;
  return {
      table<VehicleOptions>("Vehicles",
                            "Files of `config/vehicles`, which also have a `footprint`: a list of "
                            "corners [x, y] in m, x ahead, convex."),
      table<PlannerOptions>("Planner", "`semantic-map-plan`; `[planner]` of drives."),
  };
}

std::vector<OptionTable> drivingTables() {
  using namespace semantic_driving;
  using namespace simulated_drive;
  return {
      table<DriveOptions>("Driving", "`[drive]` of `semantic-map-drive` and `drive-study`."),
      table<GuideOptions>("Which path is driven", "`[guide]`."),
      table<DynamicObstacleOptions>("People and others who move", "`[movers]`."),
      table<FocusOptions>("Detail along the path",
                          "`[focus]`. What it brings: "
                          "[drives](../how-it-works/drives.md#detail-where-it-drives)."),
      table<ExploreOptions>("Exploration",
                            "`[explore]`, for `--explore`: "
                            "[exploration](../how-it-works/exploration.md)."),
      table<semantic_map_ros2::NodeOptions>(
          "ROS 2",
          "Parameters of `semantic-map-ros2`, which takes `map`, `insertion`, `abstraction`, "
          "`slam`, "
          "`planner`, `drive`, `guide`, `movers` and `focus` of the above, too: "
          "`insertion.max_range`. See [a live map in ROS 2](ros2.md)."),
  };
}

std::vector<OptionTable> seldomTables() {
  using namespace semantic_map;
  return {
      table<TLikelihoodOptions>("Likelihood of observations", "`_likelihoodOpts`."),
      table<TRenderingOptions>("The map's 3D object", "`_renderOpts`."),
  };
}

/** What a reader of the page wants to do, with its tables. */
std::vector<std::pair<std::string, std::vector<OptionTable>>> tasks() {
  return {
      {"Make maps", mapTables()},       {"Give points their classes", labelTables()},
      {"Plan", planningTables()},       {"Drive", drivingTables()},
      {"Simulate", simulationTables()}, {"Seldom needed: in MRPT's applications", seldomTables()}};
}

std::string rowOf(const Option& option) {
  const std::string value = option.text();
  return "| `" + option.name + "` | " + option.unit + " | " +
         (value.empty() ? "" : "`" + value + "`") + " | " + option.expected + " | " + option.help +
         " |\n";
}

}  // namespace

std::vector<OptionTable> optionTables() {
  std::vector<OptionTable> tables;
  for (const auto& [task, ofTask] : tasks())
    tables.insert(tables.end(), ofTask.begin(), ofTask.end());
  return tables;
}

std::string optionsPage() {
  std::string page =
      "# Options\n\n"
      "Written by a test from the lists that the programs read: do not change it by hand.\n\n"
      "Names are written with `_` in .ini files and YAML, with `-` on command lines; in .ini files "
      "neither these nor capitals tell names apart, so that `maxRange` is `max_range`, too. A name "
      "that is unknown and a value that is not allowed are errors that name file, section and key, "
      "and the nearest name that is known. What is left out has its default.\n";
  for (const auto& [task, tables] : tasks()) {
    page += "\n## " + task + "\n";
    for (const OptionTable& table : tables) {
      page += "\n### " + table.title + "\n" + table.where +
              "\n\n| option | unit | default | allowed | what |\n|---|---|---|---|---|\n";
      for (const Option& option : table.list.options()) page += rowOf(option);
    }
  }
  return page;
}
