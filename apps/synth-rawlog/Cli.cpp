#include "Cli.h"

#include <synthetic_world/Scene.h>

#include <utility>

namespace synth_rawlog {
namespace {

using strict_files::above;
using strict_files::between;
using strict_files::OptionList;

constexpr double kGreatestDepth = 65;  // m: depth images hold millimeters in 16 bits

OptionList driveOptions(Cli& cli) {
  OptionList list;
  list.add("seed", cli.seed, "", "of the world and of all noise");
  list.add("hills", cli.hills, "", between(0, 2), "factor of the ground's heights; 0 is flat");
  list.add("rate", cli.rate, "", above(0), "frames a second");
  list.add("speed", cli.speed, "m/s", above(0), "of the robot");
  list.add("start", cli.start, "m", "where on the route to begin");
  list.add("people", cli.people, "", between(0, 1000),
           "people who walk to and fro across the route");
  list.add("odometry", cli.odometry, "",
           "write movements and sensory frames instead of observations with true poses");
  list.add("odometry_noise", cli.odometryNoise, "", between(0, 1),
           "of movements, standard deviation as a share of a movement");
  return list;
}

OptionList sensorOptions(Cli& cli) {
  OptionList list;
  cli.camera.describe(list);
  list.remove("max_range");
  list.add("camera_pitch", cli.cameraPitch, "degrees", between(-80, 80), "down, of the camera");
  list.add("camera_range", cli.camera.maxRange, "m",
           above(synthetic_world::CameraOptions::kMinRange).upTo(kGreatestDepth),
           "greatest depth of the camera");
  cli.lidar.describe(list);
  for (const char* option : {"lowest", "highest", "max_range"}) list.remove(option);
  list.add("lidar_range", cli.lidar.maxRange, "m", above(synthetic_world::LidarOptions::kMinRange),
           "range of the LiDAR");
  list.add("turn_time", cli.turnTime, "s", between(0, 10),
           "time of a turn of the LiDAR: each point has its own time, and is seen from where the "
           "robot is then; 0: all at once");
  list.add("ghosts", cli.lidar.ghosts, "", between(0, 1),
           "share of the LiDAR's beams on windows, cars, water and signs that return by way of "
           "what these mirror");
  cli.noise.describe(list);
  list.add("dropout", cli.noise.dropout, "", between(0, 1), "share of rays without a return");
  return list;
}

}  // namespace

void addOptions(CLI::App& app, Cli& cli) {
  cli.outputs.add(app, cli.output, "FILE", "Rawlog to write");
  cli.outputs.addOther(app.add_option("--picture", cli.picture,
                                      "Write the world from above, colors and classes (PNG)"));
  addWords(app.add_option("--scene", cli.scene, "Which world"), synthetic_world::sceneNames())
      ->capture_default_str();
  app.add_option("--frames", cli.frames, "Number of frames; by default one round of the route")
      ->check(isNumber(between(1, 1000000)));
  addWords(app.add_option("--sensor", cli.sensor, "Sensors of the robot"),
           {"camera", "lidar", "both"})
      ->capture_default_str();
  label_noise::addLabelNoiseKind(app, cli.labelNoiseKind);
  app.add_option("--classes", cli.classes,
                 "Class table (YAML) for the labels, with the world's classes as raw ids. "
                 "Without: the world's own table");
  app.add_option("--truth-query", cli.truthQuery,
                 "Print what is at each point of this file (lines: x y z)")
      ->check(CLI::ExistingFile);
  addNumber(app, "--tolerance", cli.tolerance, strict_files::atLeast(0),
            "A point as near to a surface as this lies on it, m");
  ::addOptions(app, driveOptions(cli), "World and drive");
  ::addOptions(app, sensorOptions(cli), "Sensors");
}

void complete(Cli& cli) {
  if (cli.output.empty() && cli.truthQuery.empty() && cli.picture.empty())
    throw CLI::RequiredError("--output, --picture or --truth-query");
  if (cli.labelNoiseKind != label_noise::LabelNoise::Kind::Points)
    cli.labelNoise = std::exchange(cli.noise.label, 0);
  cli.camera.noise = cli.lidar.noise = cli.noise;
}

}  // namespace synth_rawlog
