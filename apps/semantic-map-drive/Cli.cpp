#include "Cli.h"

#include <synthetic_world/Scene.h>

#include "Choice.h"
#include "MemoryOption.h"
#include "NumberChecks.h"
#include "poses/Poses.h"

namespace semantic_map_drive {

namespace {

/** Hands each text to a function; what it throws is an error of the command line. */
template <class Take>
CLI::Option* addParsed(CLI::App& app, const std::string& name, const std::string& type, Take take,
                       const std::string& description) {
  return app
      .add_option_function<std::vector<std::string>>(
          name,
          [take, name](const std::vector<std::string>& texts) {
            try {
              for (const std::string& text : texts) take(text);
            } catch (const std::invalid_argument& e) {
              throw CLI::ValidationError(name, e.what());
            }
          },
          description)
      ->type_name(type);
}

}  // namespace

Cli::Cli(CLI::App& app) : outputs(app) {
  addWords(app.add_option("--scene,--world", scene, "Which synthetic world"),
           synthetic_world::sceneNames())
      ->capture_default_str();
  app.add_option("--seed", seed, "Seed of the world and of all noise")->capture_default_str();
  app.add_option("--hills", hills, "Factor of the ground's heights; 0 is flat")
      ->check(isNumber(strict_files::between(0.0, 2.0)))
      ->capture_default_str();
  app.add_option(
      "--map", map,
      "Map that the robot begins with (.semantic, or a folder of tiles, which stays as it "
      "is); without: none");
  addMemoryOption(app, memory);
  poses::addPose(app, "--start", start, "Where the robot is")->required();
  CLI::Option_group* where = app.add_option_group("Where to");
  poses::addPose(*where, "--goal", goal, "Where the robot shall go");
  CLI::Option* exploring =
      where->add_flag("--explore", explore, "Instead of a goal: look around until that is enough");
  where->require_option(1);
  app.add_option("--weights", weights, "What is looked for (YAML, see config/weights)")
      ->needs(exploring);
  app.add_option("--solution", solution, "Name of one solution in the weights; without: the first")
      ->needs("--weights");
  app.add_option("--order", order,
                 "Classes from best to worst (YAML); a second file makes a second drive to compare")
      ->required()
      ->expected(1, 2);
  app.add_option("--config", config, "Robot, sensors, planner (.ini, see config/drives)")
      ->required();
  outputs.add(app, output, "FOLDER", "Folder of the results, created if need be")->required();
  addEvents(app);
  app.add_option("--picture-every", pictureEvery,
                 "Write a picture every so many seconds of the drive")
      ->check(isNumber(strict_files::above(0)));
  app.add_flag("!--no-rawlog", rawlog, "Write no rawlog");
  app.add_flag("--navlog", navlog, "Write drive.reactivenavlog, for MRPT's navlog-viewer");
  app.add_flag("--live", live,
               "Show the drive in a window, no faster than real time, until the window is closed");
  app.add_flag("--compressed-pictures", compressed, "Show the compressed tree in pictures");
  app.add_flag("!--no-pictures", pictures, "Write no animation");
}

void Cli::addEvents(CLI::App& app) {
  addParsed(
      app, "--person", "T,X,Y,X2,Y2[,T2]",
      [this](auto& t) { events.persons.push_back(parsePerson(t)); },
      "Somebody walks from one place to another, from second T on, and is gone at T2");
  addParsed(
      app, "--roadblock", "T,X,Y,DEG,LENGTH",
      [this](auto& t) { events.roadblocks.push_back(parseRoadblock(t)); },
      "A barrier across a way, from second T on");
  addParsed(
      app, "--sensor-dropout", "T,T2", [this](auto& t) { events.dropouts.push_back(parseSpan(t)); },
      "The sensors see nothing from second T to T2");
}

}  // namespace semantic_map_drive
