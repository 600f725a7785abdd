#include "Cli.h"

#include <synthetic_world/Scene.h>

#include "Options.h"

namespace synth_rawlog {
namespace {

constexpr double kGreatestDepth = 65;  // m: depth images hold millimeters in 16 bits

void addScene(CLI::App& app, Cli& cli) {
  cli.outputs.add(app, cli.output, "FILE", "Rawlog to write");
  addWords(app.add_option("--scene", cli.scene, "Which world"), synthetic_world::sceneNames())
      ->capture_default_str();
  app.add_option("--seed", cli.seed, "Seed of the world and of all noise")->capture_default_str();
  addNumber(app, "--hills", cli.hills, strict_files::between(0.0, 2.0),
            "Factor of the ground's heights; 0 is flat");
}

void addDrive(CLI::App& app, Cli& cli) {
  app.add_option("--frames", cli.frames, "Number of frames; by default one round of the route")
      ->check(isNumber(strict_files::between(1, 1000000)));
  addNumber(app, "--rate", cli.rate, strict_files::above(0), "Frames a second");
  addNumber(app, "--speed", cli.speed, strict_files::above(0), "Speed of the robot, m/s");
  app.add_option("--start", cli.start, "Where on the route to begin, m")->capture_default_str();
  addNumber(app, "--people", cli.people, strict_files::between(0, 1000),
            "People who walk to and fro across the route");
  app.add_flag("--odometry", cli.odometry,
               "Write movements and sensory frames instead of observations with true poses");
  addNumber(app, "--odometry-noise", cli.odometryNoise, strict_files::between(0.0, 1.0),
            "Noise of movements, standard deviation as a share of a movement");
}

void addSensors(CLI::App& app, Cli& cli) {
  addWords(app.add_option("--sensor", cli.sensor, "Sensors of the robot"),
           {"camera", "lidar", "both"})
      ->capture_default_str();
  app.add_option("--width", cli.camera.width, "Width of the camera's images, pixels")
      ->capture_default_str();
  app.add_option("--height", cli.camera.height, "Height of the camera's images, pixels")
      ->capture_default_str();
  app.add_option("--fov", cli.camera.horizontalFov,
                 "Horizontal field of view of the camera, degrees")
      ->capture_default_str();
  addNumber(app, "--camera-pitch", cli.cameraPitch, strict_files::between(-80.0, 80.0),
            "How far the camera looks down, degrees");
  app.add_option("--camera-range", cli.camera.maxRange, "Largest depth of the camera, m")
      ->capture_default_str();
  app.add_option("--rings", cli.lidar.rings, "Rings of the LiDAR")->capture_default_str();
  app.add_option("--columns", cli.lidar.columns, "Beams of each ring in one turn")
      ->capture_default_str();
  app.add_option("--lidar-range", cli.lidar.maxRange, "Largest range of the LiDAR, m")
      ->capture_default_str();
  addNumber(app, "--turn-time", cli.turnTime, strict_files::between(0.0, 10.0),
            "Time that a turn of the LiDAR takes, s: points are seen from where it is by then, and "
            "have times");
  app.add_option("--ghosts", cli.lidar.ghosts,
                 "Share of the LiDAR's beams on windows, cars, water and signs that return by way "
                 "of what these mirror")
      ->capture_default_str();
  app.add_option("--range-noise", cli.noise.range,
                 "Noise of depths and ranges, standard deviation, m")
      ->capture_default_str();
  app.add_option("--label-noise", cli.labelNoise, "Share of labels that are wrong")
      ->capture_default_str();
  label_noise::addLabelNoiseKind(app, cli.labelNoiseKind);
  app.add_option("--dropout", cli.noise.dropout, "Share of rays without a return")
      ->capture_default_str();
  app.add_option("--classes", cli.classes,
                 "Class table (YAML) for the labels; its raw ids name the world's classes. "
                 "Without: the world's own table");
}

void addTruth(CLI::App& app, Cli& cli) {
  app.add_option("--truth-query", cli.truthQuery,
                 "Print what is at each point of this file (lines: x y z)")
      ->check(CLI::ExistingFile);
  addNumber(app, "--tolerance", cli.tolerance, strict_files::atLeast(0),
            "What is this near to a surface is on it, m");
  cli.outputs.addOther(app.add_option("--picture", cli.picture,
                                      "Write the world from above, colors and classes (PNG)"));
}

}  // namespace

void addOptions(CLI::App& app, Cli& cli) {
  addScene(app, cli);
  addDrive(app, cli);
  addSensors(app, cli);
  addTruth(app, cli);
}

void complete(Cli& cli) {
  if (cli.output.empty() && cli.truthQuery.empty() && cli.picture.empty())
    throw CLI::RequiredError("--output, --picture or --truth-query");
  if (cli.labelNoiseKind == label_noise::LabelNoise::Kind::Points) cli.noise.label = cli.labelNoise;
  cli.camera.noise = cli.lidar.noise = cli.noise;
  cli.camera.validate();
  cli.lidar.validate();
  if (cli.camera.maxRange > kGreatestDepth)
    throw std::invalid_argument("--camera-range is " + std::to_string(cli.camera.maxRange) +
                                ", at most 65 m expected");
}

}  // namespace synth_rawlog
