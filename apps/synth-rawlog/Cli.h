#pragma once
#include <synthetic_world/Sensors.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "Application.h"
#include "label_noise/LabelNoise.h"

namespace synth_rawlog {

/** The command line. */
struct Cli {
  std::filesystem::path output;  // the rawlog; empty if only the truth or a picture is wanted
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
  synthetic_world::SensorNoise noise{0.01, 0, 0};
  double labelNoise = 0;  // share of labels, of other kinds than points
  label_noise::LabelNoise::Kind labelNoiseKind = label_noise::LabelNoise::Kind::Points;

  std::filesystem::path classes;  // table whose raw ids are the world's classes; empty: the world's
  std::filesystem::path truthQuery, picture;
  double tolerance = 0.05;  // m

  Outputs outputs;

  explicit Cli(CLI::App& app) : outputs(app) {}
  bool wantsCamera() const { return sensor != "lidar"; }
  bool wantsLidar() const { return sensor != "camera"; }
};

/** Declares all options; parsing fills `cli`. */
void addOptions(CLI::App& app, Cli& cli);

/** Brings the parsed noise to the sensors. \throw CLI::RequiredError nothing is to be written. */
void complete(Cli& cli);

}  // namespace synth_rawlog
