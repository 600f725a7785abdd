#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "RunProgram.h"
#include "TemporaryFolder.h"

/** Runs semantic-map-drive over some meters of the village. */
class SemanticMapDrive : public testing::Test {
 protected:
  std::vector<std::string> argumentsWith(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {
        "--world",          "village", "--start=-14,-19,10",
        "--goal=-6,-17,20", "--order", kConfig + "orders/synthetic.yaml",
        "--no-pictures",    "-f"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  ProgramRun drive(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments =
        argumentsWith({"--config", kConfig + "drives/synthetic.ini", "--output", path("drive")});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram("semantic-map-drive", arguments);
  }

  /** A configuration whose section [drive] says this; other keys have their defaults. */
  std::string configWith(const std::string& lines) const {
    return folder
        .write("drive.ini", "[planner]\nvehicle = " + kConfig +
                                "vehicles/robot.yaml\nkeepOff = 1\n" +
                                "[drive]\nreactive = " + kConfig + "reactive/robot.ini\n" + lines)
        .string();
  }

  nlohmann::json jsonIn(const std::string& file) const {
    return nlohmann::json::parse(std::ifstream(path(file)));
  }
  bool has(const std::string& file) const { return std::filesystem::exists(path(file)); }
  std::string path(const std::string& name) const { return (folder / name).string(); }

  const std::string kConfig = std::string(MSO_SOURCE_DIR) + "/config/";
  TemporaryFolder folder;
};
