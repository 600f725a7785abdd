// Receives a map from semantic-map-send, over a radio that may lose, exchange and repeat datagrams.
#include <map_folders/MapFolder.h>
#include <semantic_octree/TreeFile.h>
#include <strict_files/TextFile.h>

#include <filesystem>
#include <ostream>

#include "Application.h"
#include "NumberChecks.h"
#include "Outputs.h"
#include "Reception.h"
#include "StandardOutput.h"

namespace semantic_map_receive {
namespace {

namespace fs = std::filesystem;
using semantic_octree::SemanticOcTree;

struct Cli {
  std::string sender;
  fs::path output, weights, like, key;
  radio::Wish wish;
  ReceptionOptions reception;
  Outputs outputs;

  explicit Cli(CLI::App& app) : outputs(app) {
    app.add_option("SENDER", sender,
                   "Where semantic-map-send is, HOST:PORT; the port may be left out (4217)")
        ->required();
    outputs.add(app, output, "FILE", "The map to write (.semantic)")->required();
    app.add_option("--weights", weights, "Weights of classes (YAML); without: the sender's");
    app.add_option("--solution", wish.solution, "Name of one solution in the weights (the first)");
    app.add_option("--alpha", wish.alpha, "The price of detail, instead of the weights' own")
        ->check(isNumber(strict_files::atLeast(0)));
    app.add_option("--bytes", reception.bytes, "End when this many bytes came without a gap")
        ->check(isNumber(strict_files::above(0)));
    app.add_option("--like", like, "Refuse a map whose classes or voxels differ from this map's");
    app.add_option(
        "--key", key,
        "Listen only to a sender with this key: a file of 16 bytes or more, the same on both "
        "sides");
    app.add_option("--timeout", reception.timeout,
                   "End when the sender is silent for this long, s (60)")
        ->check(isNumber(strict_files::above(0)));
    app.add_option("--lose", reception.loss,
                   "Try a bad radio: lose this share of what goes to the sender (0)")
        ->check(isNumber(strict_files::between(0, 0.99)));
    app.add_option("--seed", reception.seed, "Seed of the losses (2)");
    app.add_flag_callback("-v,--verbose", beVerbose, "Tell of foreign datagrams");
  }
};

radio::Peer peerOf(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return radio::Peer::of(text, 4217);
  const std::string port = text.substr(colon + 1);
  const bool isNumber =
      !port.empty() && port.size() < 6 && port.find_first_not_of("0123456789") == std::string::npos;
  if (!isNumber || std::stoi(port) < 1 || std::stoi(port) > 65535)
    throw std::runtime_error("expected HOST:PORT with a port from 1 to 65535, found '" + text +
                             "'");
  return radio::Peer::of(text.substr(0, colon), std::stoi(port));
}

/** \throw std::runtime_error maps of this kind cannot be shared with that file's. */
void checkKind(const SemanticOcTree& received, const SemanticOcTree& own, const fs::path& file) {
  if (received.classes() != own.classes())
    throw std::runtime_error("the sender's class table is not that of " + file.string());
  if (received.getResolution() != own.getResolution())
    throw std::runtime_error("the sender's voxels of " + std::to_string(received.getResolution()) +
                             " m are not those of " + file.string());
}

void save(const Reception& reception, const fs::path& file) {
  const semantic_octree::MapReceiver& receiver = reception.receiver();
  if (!receiver.hasMap()) return;
  semantic_octree::saveTree(receiver.map(), file.string());
  notes() << file.string() << ": " << receiver.numLeaves() << " leaves, " << receiver.numPackets()
          << " of " << receiver.numExpected() << " packets" << std::endl;
}

int run(Cli& cli) {
  cli.outputs.check({cli.output});
  if (!cli.weights.empty()) cli.wish.weights = strict_files::readText(cli.weights);
  std::optional<SemanticOcTree> own;
  if (!cli.like.empty()) own = semantic_octree::loadMap(cli.like.string());
  const StopRequest stop("after this packet");
  Reception reception(peerOf(cli.sender), cli.wish,
                      cli.key.empty() ? radio::Seal() : radio::Seal(cli.key), cli.reception);
  bool isOurs = false;
  try {
    reception.receive(stop, [&](const SemanticOcTree& map) {
      if (own) checkKind(map, *own, cli.like);
      isOurs = true;
    });
  } catch (const std::runtime_error&) {
    if (isOurs) save(reception, cli.output);
    throw;
  }
  save(reception, cli.output);
  reception.end();
  return 0;
}

}  // namespace
}  // namespace semantic_map_receive

int main(int argc, char** argv) {
  CLI::App app("Receives a semantic octree map from semantic-map-send over a thin radio");
  semantic_map_receive::Cli cli(app);
  return runApplication(app, argc, argv, [&] { return semantic_map_receive::run(cli); });
}
