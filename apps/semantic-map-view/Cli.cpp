#include "Cli.h"

#include "Choice.h"
#include "MemoryOption.h"
#include "NumberChecks.h"

namespace semantic_map_view {

namespace {

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

void readCamera(const std::string& text, Cli& cli) {
  try {
    cli.view.camera = map_view::OrbitCamera::ofText(text);
  } catch (const std::invalid_argument& e) {
    throw CLI::ValidationError(std::string("--camera ") + e.what());
  }
}

void readClip(const std::string& text, Cli& cli) {
  std::istringstream in(text);
  std::array<double, 6> numbers{};
  char comma = ',';
  for (std::size_t i = 0; i < numbers.size() && comma == ','; ++i) {
    if (i > 0) in >> comma;
    in >> numbers[i];
  }
  const Eigen::Vector3d low(numbers[0], numbers[1], numbers[2]),
      high(numbers[3], numbers[4], numbers[5]);
  if (!in || comma != ',' || !(in >> std::ws).eof() || !(low.array() < high.array()).all())
    throw CLI::ValidationError("--clip is '" + text +
                               "', expected X,Y,Z,X2,Y2,Z2, the lowest corner first");
  cli.view.style.clip = {low, high};
}

}  // namespace

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
  auto* from = app.add_option_function<std::string>(
      "--camera", [this](const std::string& text) { readCamera(text, *this); },
      "Point looked at, distance (m), azimuth, elevation (degrees), as the window says them");
  from->type_name("X,Y,Z,DISTANCE,AZIMUTH,ELEVATION");
  app.add_flag("--top", view.top, "From above, north up")->excludes(from);
  std::map<std::string, map_view::ViewColoring> colorings;
  for (const auto& [name, value] : choicesOf(map_view::ViewColoring())) colorings[name] = value;
  addChoice(app.add_option("--color", view.style.coloring, "What the colors of cells mean"),
            colorings);
  auto* clip = app.add_option_function<std::string>(
      "--clip", [this](const std::string& text) { readClip(text, *this); },
      "Show only cells with their centers in this box, m");
  clip->type_name("X,Y,Z,X2,Y2,Z2");
  app.add_option("--max-height", view.style.clip.max().z(),
                 "Show no cells with their centers above this height, m")
      ->check(isNumber({}))
      ->excludes(clip);
  app.add_flag("--free", view.style.freeSpace, "Show free space");
  app.add_flag("--unknown", view.style.unknownSpace,
               "Show unknown space within the map's bounding box, or the box of --clip");
  app.add_option("--weights", weights,
                 "Where the sliders of the compression begin: the first solution of such a file "
                 "(YAML, as for semantic-map-compress)");
  app.add_option("--classes", classes,
                 "Classes from best to worst, for paths (YAML, as for semantic-map-plan)");
  app.add_flag("--compress", compress, "Begin with the compressed tree");
  app.add_flag("!--no-panels", panels, "Hide the panels")->excludes(animated);
}

}  // namespace semantic_map_view
