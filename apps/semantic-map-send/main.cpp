// Sends a map's compressed tree over a thin radio, what matters most first.
#include <strict_files/TextFile.h>

#include <filesystem>
#include <ostream>

#include "Application.h"
#include "MemoryOption.h"
#include "NumberChecks.h"
#include "StandardOutput.h"
#include "Station.h"
#include "inputs/Inputs.h"

namespace semantic_map_send {
namespace {

namespace fs = std::filesystem;

struct Cli {
  std::vector<fs::path> maps;
  fs::path weights, key;
  double memory = semantic_octree::MapFolderOptions().memory;
  radio::Wish own;
  StationOptions station;

  explicit Cli(CLI::App& app) {
    app.add_option("MAP", maps,
                   std::string("Map to send (") + inputs::kMap +
                       "); of later versions of it, given after it, only what changed is sent")
        ->required();
    addMemoryOption(app, memory);
    app.add_option("--rate", station.rate,
                   "Bits a second, headers of IP and UDP included; without: as fast as possible")
        ->check(isNumber(strict_files::above(0)));
    app.add_option("--port", station.port,
                   "UDP port to listen at; 0: any free one, which is printed")
        ->check(isNumber(strict_files::between(0, 65535)))
        ->capture_default_str();
    app.add_option("--weights", weights, "Weights for receivers that send none (YAML)");
    app.add_option("--solution", own.solution,
                   "Name of one solution in the weights; without: the first")
        ->type_name("NAME");
    app.add_option(
        "--key", key,
        "Serve only receivers with this key: a file of 16 bytes or more, the same on both sides");
    app.add_option("--receivers", station.receivers,
                   "End after this many receivers; up to 16 are served at once, 4 of one address")
        ->check(isNumber(strict_files::above(0)))
        ->capture_default_str();
    app.add_option("--timeout", station.timeout,
                   "Forget a receiver that is silent for this long; end if none is left, s")
        ->check(isNumber(strict_files::above(0)))
        ->capture_default_str();
    app.add_option("--lose", station.loss,
                   "Try a bad radio: lose this share of the datagrams, send some twice, some late")
        ->check(isNumber(strict_files::between(0, 0.99)))
        ->capture_default_str();
    app.add_option("--seed", station.seed, "Seed of the losses")->capture_default_str();
    app.add_flag_callback("-q,--quiet", beQuiet, "Say nothing but errors");
    app.add_flag_callback("-v,--verbose", beVerbose, "Tell of foreign datagrams");
  }
};

/** \throw std::runtime_error naming a file that cannot be read, before anybody waits for it. */
void open(const Cli& cli, Maps& maps) {
  for (const fs::path& path : cli.maps) {
    inputs::appendMap(maps, path, cli.memory / static_cast<double>(cli.maps.size()));
    if (!maps.back().folder()) continue;
    for (const std::string& problem : maps.back().folder()->problems())
      throw std::runtime_error(problem);
  }
}

int run(Cli& cli) {
  if (!cli.weights.empty()) cli.own.weights = strict_files::readText(cli.weights);
  Maps maps;
  open(cli, maps);
  if (!cli.weights.empty()) cli.own.forClasses(maps.front().tree().classes(), cli.weights.string());
  const StopRequest stop("after this datagram");
  Station station(maps, cli.own, cli.key.empty() ? radio::Seal() : radio::Seal(cli.key),
                  cli.station);
  notes() << "Waiting at port " << station.port() << std::endl;
  station.serve(stop);
  return 0;
}

}  // namespace
}  // namespace semantic_map_send

int main(int argc, char** argv) {
  CLI::App app("Sends a semantic octree map over a thin radio, what matters most first");
  semantic_map_send::Cli cli(app);
  return runApplication(app, argc, argv, [&] { return semantic_map_send::run(cli); });
}
