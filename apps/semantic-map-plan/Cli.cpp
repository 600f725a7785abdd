#include "Cli.h"

#include <cmath>
#include <sstream>

#include "OptionFlags.h"

namespace semantic_map_plan {

using mrpt::math::TPose2D;

namespace {

/** "X,Y,DEG" */
TPose2D parsePose(const std::string& text) {
  std::istringstream in(text);
  double x = NAN, y = NAN, degrees = NAN;
  char comma1 = 0, comma2 = 0;
  in >> x >> comma1 >> y >> comma2 >> degrees;
  const bool complete = in && (in >> std::ws).eof() && comma1 == ',' && comma2 == ',';
  if (!complete || !std::isfinite(x + y + degrees))
    throw CLI::ValidationError("expected X,Y,DEG (meters and degrees), found " + text);
  return {x, y, degrees * M_PI / 180};
}

CLI::Option* addPose(CLI::App& app, const std::string& name, TPose2D& pose,
                     const std::string& description) {
  return app
      .add_option_function<std::string>(
          name, [&pose](const std::string& text) { pose = parsePose(text); }, description)
      ->type_name("X,Y,DEG");
}

}  // namespace

void Cli::addTo(CLI::App& app) {
  app.add_option("MAP", map, "A map's own file (.semantic)")->required();
  addPose(app, "--start", start, "Where the vehicle is")->required();
  addPose(app, "--goal", goal, "Where it is to go")->required();
  app.add_option("--start-z", startZ, "Height, where the ground has several levels, m");
  app.add_option("--goal-z", goalZ, "Height of the goal, m");
  app.add_option("--classes", classes, "Classes from best to worst (YAML)")->required();
  app.add_option("--vehicle", vehicle, "Its measures (YAML); none: a small robot");
  app.add_option("--weights", weights,
                 "What the compressed tree keeps (YAML, as for semantic-map-compress); "
                 "none: what tells the ranks of --classes apart");
  app.add_option("--solution", solution, "Which of the weights; none: the first")
      ->needs("--weights");
  app.add_option("--output", output, "Folder of the results, created if need be")->required();
  planner.shorten = true;
  strict_files::OptionList options;
  planner.describe(options);
  addOptions(app, options, "Planner");
}

}  // namespace semantic_map_plan
