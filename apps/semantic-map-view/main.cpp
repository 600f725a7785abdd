// Shows semantic octree maps in a window.
#include <map_pictures/MapPictures.h>
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_planning/planner/OrderFile.h>

#include <iostream>

#include "Animation.h"
#include "Application.h"
#include "Cli.h"
#include "CompressPanel.h"
#include "FilesPanel.h"
#include "PlanPanel.h"
#include "StandardOutput.h"
#include "WhyPanel.h"
#include "map_window/AskPanel.h"
#include "map_window/ShowPanel.h"
#include "measuring/Quantile.h"
#include "measuring/Stopwatch.h"

namespace semantic_map_view {
namespace {

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
  if (!cli.classes.empty()) semantic_planning::loadClassOrder(cli.classes, classes);
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
        plan(viewer, cli.classes),
        files(viewer, tracks, cli.wantedTiles()) {
    viewer.window().onClick([this](const map_view::Ray& ray) { why.show(ask.ask(ray)); });
    viewer.window().onGrab([this](const map_view::Ray& ray) { return plan.place(ray); });
    viewer.window().onMoved(
        [this](const map_view::Ray& ray, bool letsGo) { plan.turn(ray, letsGo); });
    if (cli.compress) compress.switchOn(true);
  }
};

void finishFrame(ViewWindow& window) {
  while (window.drawFrame()) {
  }
}

/** With three digits. */
std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, value < 100 ? "%.3g" : "%.0f", value);
  return text;
}

/** Times on the wall and, as others may use the machine, of the processor's cores. */
struct Clock {
  measuring::Stopwatch wall{measuring::TimeOf::Wall}, cores{measuring::TimeOf::Process};
  std::string text(int times = 1) const {
    const auto ms = [times](const measuring::Stopwatch& watch) {
      return number(watch.milliseconds() / times);
    };
    return ms(wall) + " ms (of the cores " + ms(cores) + " ms)";
  }
};

/** Medians of such times. */
struct Clocks {
  std::vector<double> wall, cores;
  void add(const Clock& clock) {
    wall.push_back(clock.wall.milliseconds());
    cores.push_back(clock.cores.milliseconds());
  }
  std::string text() const {
    return number(measuring::quantile(wall, 0.5)) + " ms (of the cores " +
           number(measuring::quantile(cores, 0.5)) + " ms)";
  }
};

/** Twice around the map: with meshes to be made, and with all there. */
void measureTurning(ViewWindow& window, Viewer& viewer) {
  constexpr int kFrames = 72;
  map_view::OrbitCamera camera = window.orbitCamera();
  for (const char* name : {"a frame of the first turn: ", "a frame of the second turn: "}) {
    const Clock clock;
    for (int i = 0; i < kFrames; ++i) {
      camera.azimuth += 360.0 / kFrames;
      window.setOrbitCamera(camera);
      window.drawFrame();
    }
    std::cout << name << clock.text(kFrames) << '\n';
  }
  std::cout << "tiles: " << viewer.tiles().numTiles()
            << "\nsides of cells: " << viewer.tiles().numFaces() << '\n';
}

/** From the hand on the slider to the first frame that shows it, and to the complete one. */
void measureCompressing(ViewWindow& window, CompressPanel& panel) {
  const auto show = [&](const std::string& name, const auto& change) {
    constexpr int kTimes = 9;
    Clocks first, complete;
    for (int i = 0; i < kTimes; ++i) {
      const Clock clock;
      change(i);
      window.drawFrame();
      first.add(clock);
      finishFrame(window);
      complete.add(clock);
    }
    std::cout << "from " << name << " to the first frame: " << first.text()
              << ", to the complete one: " << complete.text() << '\n';
  };
  const Clock begin;
  panel.switchOn(true);
  finishFrame(window);
  std::cout << "to the compressed tree: " << begin.text() << '\n';
  const double alpha = panel.compression()->alpha();
  show("alpha", [&](int i) { panel.setAlpha(alpha * (i % 2 ? 1 : 1.5)); });
  show("a weight", [&](int i) { panel.setWeight(1, i % 2 ? 1 : 0.5); });
}

void measureAsking(ViewWindow& window, AskPanel& panel) {
  constexpr int kTimes = 100;
  beQuiet();
  const Clock clock;
  for (int i = 0; i < kTimes; ++i)
    panel.ask(window.orbitCamera().rayThrough(window.pixelWidth() * i / kTimes,
                                              window.pixelHeight() / 2, window.pixelWidth(),
                                              window.pixelHeight()));
  std::cout << "from a click to the answer: " << clock.text(kTimes) << '\n';
}

int run(const Cli& cli) {
  for (const auto& file : {cli.picture, cli.animation})
    if (!file.empty()) cli.outputs.check({file});
  const Clock clock;
  Opened opened(cli);
  checkSettings(cli, opened.layers.front()->map().classes());
  const WindowSystem system;
  const auto window = ViewWindow::open("semantic-map-view", cli.width, cli.height);
  Viewer viewer(*window, std::move(opened.layers), cli.view);
  for (std::size_t i = 0; i < viewer.numLayers(); ++i)
    if (const auto& note = viewer.layer(i).note(); !note.empty()) viewer.say(note);
  TrackScene tracks(viewer);
  for (Track& track : opened.tracks) tracks.add(std::move(track));
  std::optional<Panels> panels;
  if (cli.panels) panels.emplace(viewer, tracks, cli);
  window->performLayout();
  window->setVisible(true);
  if (cli.measure || !cli.picture.empty() || !cli.animation.empty()) {
    finishFrame(*window);
    if (cli.measure) {
      std::cout << "renderer: " << window->renderer() << "\nwindow: " << window->pixelWidth()
                << " x " << window->pixelHeight()
                << "\nto the first complete frame: " << clock.text() << '\n';
      measureTurning(*window, viewer);
      if (panels) measureAsking(*window, panels->ask);
      if (panels) measureCompressing(*window, panels->compress);
    }
    if (!cli.picture.empty()) map_pictures::savePicture(window->drawPicture(), cli.picture);
    if (panels && !cli.animation.empty()) animate(*window, panels->compress, cli.animation);
    return 0;
  }
  window->run([] { return false; });
  return 0;
}

}  // namespace
}  // namespace semantic_map_view

int main(int argc, char** argv) {
  CLI::App app("Shows semantic octree maps in a window: turn them, ask them, compress them, plan");
  const semantic_map_view::Cli cli(app);
  return runApplication(app, argc, argv, [&] { return semantic_map_view::run(cli); });
}
