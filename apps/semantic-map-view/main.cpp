// Shows semantic octree maps in a window.
#include <map_pictures/MapPictures.h>
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_planning/planner/OrderFile.h>

#include "Animation.h"
#include "Application.h"
#include "Cli.h"
#include "CompressPanel.h"
#include "FilesPanel.h"
#include "PlanPanel.h"
#include "WhyPanel.h"
#include "map_window/AskPanel.h"
#include "map_window/ShowPanel.h"

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

int run(const Cli& cli) {
  for (const auto& file : {cli.picture, cli.animation})
    if (!file.empty()) cli.outputs.check({file});
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
  if (!cli.picture.empty() || !cli.animation.empty()) {
    finishFrame(*window);
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
