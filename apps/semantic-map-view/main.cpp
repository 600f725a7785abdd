// Shows semantic octree maps in a window.
#include <map_pictures/MapCanvas.h>
#include <map_pictures/MapPictures.h>
#include <map_pictures/PictureFiles.h>
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_planning/planner/OrderFile.h>
#include <semantic_planning/vehicle/VehicleOptions.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "Application.h"
#include "CompressPanel.h"
#include "FilesPanel.h"
#include "PlanPanel.h"
#include "map_window/ShowPanel.h"
#include "map_window/Viewer.h"
#include "poses/Poses.h"

namespace semantic_map_view {
namespace {
using namespace map_window;

struct Cli {
  std::vector<std::filesystem::path> files;
  std::filesystem::path picture, animation, weights, order, vehicle;
  double memory = semantic_octree::MapFolderOptions().memory;
  int width = 1280, height = 720;
  Beginning view;
  bool panels = true, compress = false;
  Outputs outputs;

  explicit Cli(CLI::App& app);
  WantedTiles wantedTiles() const { return {memory, view.style.clip}; }
};

/** Smaller windows have no room for their panels; larger ones no graphics card can draw. */
constexpr int kLeast = 320, kMost = 8192;

void readSize(const std::string& text, Cli& cli) {
  std::istringstream in(text);
  char by = 0;
  int width = 0, height = 0;
  in >> width >> by >> height;
  const auto fits = [](int pixels) { return pixels >= kLeast && pixels <= kMost; };
  if (!in || by != 'x' || !in.eof() || !fits(width) || !fits(height))
    throw CLI::ValidationError("--size is '" + text + "', expected WIDTHxHEIGHT of 320 to 8192");
  cli.width = width, cli.height = height;
}

Eigen::AlignedBox3d parseClip(const std::string& text) {
  const std::string expected = "X,Y,Z,X2,Y2,Z2, the lowest corner first";
  const auto numbers = poses::parseNumbers(text, 6, 6, expected);
  const Eigen::Vector3d low(numbers.data()), high(numbers.data() + 3);
  if (!(low.array() < high.array()).all())
    throw std::invalid_argument("expected " + expected + ", found '" + text + "'");
  return {low, high};
}

Cli::Cli(CLI::App& app) : outputs(app) {
  app.add_option("FILE", files,
                 "Maps (.semantic, folders of tiles, OctoMap's .ot and .bt), shown together, and "
                 "what lies upon them: trajectories (.tum, .txt), paths (path.csv, drive.csv)")
      ->required();
  addMemoryOption(app, memory);
  outputs.add(app, picture, "FILE", "Draw once, write the window's picture (PNG), and end");
  auto* animated = app.add_option("--animation", animation,
                                  "Turn once around the map while it is compressed more and less, "
                                  "write that (GIF), and end");
  outputs.addOther(animated);
  app.add_option_function<std::string>(
         "--size", [this](const std::string& text) { readSize(text, *this); },
         "Size of the window, pixels")
      ->type_name("WIDTHxHEIGHT");
  auto* from = poses::addParsed(
      app, "--camera", "X,Y,Z,DISTANCE,AZIMUTH,ELEVATION",
      [this](const std::string& text) { view.camera = map_view::OrbitCamera::ofText(text); },
      "Point looked at, distance (m), azimuth, elevation (degrees), as the panel Map shows them");
  app.add_flag("--top", view.top, "From above, north up")->excludes(from);
  std::map<std::string, map_view::ViewColoring> colorings;
  for (const auto& [name, value] : choicesOf(map_view::ViewColoring())) colorings[name] = value;
  addChoice(app.add_option("--color", view.style.coloring,
                           "What the colors of cells show; gain: what another look "
                           "would tell; retained: what the compression keeps"),
            colorings);
  auto* clip = poses::addParsed(
      app, "--clip", "X,Y,Z,X2,Y2,Z2",
      [this](const std::string& text) { view.style.clip = parseClip(text); },
      "Show only cells with their centers in this box, m");
  app.add_option("--max-height", view.style.clip.max().z(),
                 "Show no cells with their centers above this height, m")
      ->check(isNumber({}))
      ->excludes(clip);
  app.add_flag("--free", view.style.freeSpace, "Show free space");
  app.add_flag("--unknown", view.style.unknownSpace,
               "Show unknown space within the map's bounding box, or the box of --clip");
  app.add_option("--weights", weights,
                 "Weights with which the compression begins (YAML, as for semantic-map-compress): "
                 "the first solution");
  app.add_option("--order", order,
                 "Classes from best to worst, for paths (YAML, as for semantic-map-plan); without: "
                 "those that are checked in the window");
  app.add_option("--vehicle", vehicle, "The vehicle (YAML), for paths; without: a small robot");
  app.add_flag("--compress", compress, "Begin with the compressed tree");
  app.add_flag("!--no-panels", panels, "Hide the panels")->excludes(animated);
}

constexpr int kPictures = 72;
constexpr double kPeriod = 0.28;  // s a frame: 20 s in all
/** A share of the leaves that the tree has at first. */
constexpr double kFewest = 0.004;

cv::Mat restingPicture(ViewWindow& window) {
  while (window.drawFrame()) {
  }
  return window.drawPicture();
}

/** Once around the map while its compressed tree goes from nearly all leaves to few and back, as a
 * GIF. Its scale holds in the middle of the picture. \throw std::runtime_error naming the file: it
 * cannot be written */
void animate(ViewWindow& window, CompressPanel& panel, const std::filesystem::path& file) {
  map_pictures::GifFile gif(file, kPeriod);
  panel.switchOn(true);
  panel.setAlpha(0);
  const double most = double(panel.compression()->numLeaves());
  map_view::OrbitCamera camera = window.orbitCamera();
  for (int i = 0; i < kPictures; ++i) {
    const double turned = 2 * M_PI * i / kPictures;
    panel.setLeaves(std::size_t(most * std::pow(kFewest, (1 - std::cos(turned)) / 2)));
    panel.measure();
    window.setOrbitCamera(camera);
    cv::Mat picture = restingPicture(window);
    map_pictures::drawScaleBar(picture, camera.focalLength(window.pixelHeight()) / camera.distance);
    gif.add(picture);
    camera.azimuth += 360.0 / kPictures;
  }
  gif.close();
}

/** What was named on the command line. */
struct Opened {
  std::vector<std::unique_ptr<Layer>> layers;
  std::vector<Track> tracks;

  explicit Opened(const Cli& cli) {
    for (const auto& file : cli.files)
      if (isTrack(file))
        tracks.push_back(readTrack(file));
      else
        layers.push_back(std::make_unique<Layer>(file, cli.wantedTiles()));
    if (layers.empty())
      throw std::runtime_error("there is no map beside '" + cli.files.front().string() + "'");
  }
};

/** What is wrong with them should be said before a window opens. */
void checkSettings(const Cli& cli, const semantic_types::ClassTable& classes) {
  if (!cli.weights.empty()) semantic_octree::loadWeights(cli.weights, classes);
  if (!cli.order.empty()) semantic_planning::loadClassOrder(cli.order, classes);
  if (!cli.vehicle.empty()) semantic_planning::loadVehicle(cli.vehicle);
}

struct Panels {
  ShowPanel show;
  AskPanel ask;
  CompressPanel compress;
  WhyPanel why;
  PlanPanel plan;
  FilesPanel files;

  Panels(Viewer& viewer, TrackScene& tracks, const Cli& cli)
      : show(viewer),
        ask(viewer),
        compress(viewer, cli.weights),
        why(viewer, compress),
        plan(viewer, cli.order, cli.vehicle),
        files(viewer, tracks, plan, cli.wantedTiles()) {
    if (cli.compress) compress.switchOn(true);
    cli.panels ? listen(viewer.window()) : viewer.window().hidePanels();
  }

 private:
  void listen(ViewWindow& window) {
    window.onClick([this](const map_view::Ray& ray) { why.show(ask.ask(ray)); });
    window.onGrab([this](const map_view::Ray& ray) { return plan.place(ray); });
    window.onMoved([this](const map_view::Ray& ray, bool letsGo) { plan.turn(ray, letsGo); });
  }
};

int run(const Cli& cli) {
  for (const auto& file : {cli.picture, cli.animation})
    if (!file.empty()) cli.outputs.check({file});
  Opened opened(cli);
  checkSettings(cli, opened.layers.front()->map().classes());
  const WindowSystem system;
  const auto window = ViewWindow::open("semantic-map-view", cli.width, cli.height);
  Viewer viewer(*window, std::move(opened.layers), cli.view);
  TrackScene tracks(viewer);
  for (Track& track : opened.tracks) tracks.add(std::move(track));
  Panels panels(viewer, tracks, cli);
  window->setVisible(true);
  if (!cli.picture.empty() || !cli.animation.empty()) {
    const cv::Mat picture = restingPicture(*window);
    if (!cli.picture.empty()) map_pictures::savePicture(picture, cli.picture);
    if (!cli.animation.empty()) animate(*window, panels.compress, cli.animation);
    return 0;
  }
  window->run();
  return 0;
}

}  // namespace

}  // namespace semantic_map_view

int main(int argc, char** argv) {
  CLI::App app("Shows semantic octree maps in a window: turn them, ask them, compress them, plan");
  const semantic_map_view::Cli cli(app);
  return runApplication(app, argc, argv, [&] { return semantic_map_view::run(cli); });
}
