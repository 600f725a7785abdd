#include "Cli.h"

#include <colored_graph/EdgeModelNames.h>

#include <map>

#include "Choice.h"
#include "poses/Poses.h"

namespace semantic_map_plan {

using namespace semantic_planning;
using colored_graph::CostKind;

namespace {

void addRoadmap(CLI::App& app, RoadmapOptions& roadmap) {
  auto* group = app.add_option_group("Graph");
  addChoice(group->add_option("--graph", roadmap.kind, "Where its vertices come from"),
            graphKinds());
  group->add_option("--vertices", roadmap.vertices, "How many; 0: all that the map offers")
      ->capture_default_str();
  group->add_option("--max-edges", roadmap.edges, "Most edges; 0: as the neighbors give")
      ->capture_default_str();
  group->add_option("--neighbors", roadmap.neighbors, "Each vertex is connected with so many")
      ->capture_default_str();
  group->add_option("--longest-edge", roadmap.connectionRadius, "m")->capture_default_str();
  group->add_option("--headings", roadmap.headings, "At each point (compressed, full)")
      ->capture_default_str();
  group->add_option("--spacing", roadmap.spacing, "Between points in large leaves, m")
      ->capture_default_str();
  group->add_option("--buffer", roadmap.regionBuffer, "Around the line from start to goal, m")
      ->capture_default_str();
  group->add_flag(
      "--class-of-leaf", roadmap.classOfLeaf,
      "Vertices have the class of their leaf, not of the ground (with --edges endpoint)");
  group->add_option("--seed", roadmap.seed, "Other vertices of the same kind")
      ->capture_default_str();
}

void addJudgment(CLI::App& app, PlannerOptions& planner) {
  auto* group = app.add_option_group("Cost");
  addChoice(
      group->add_option("--cost", planner.cost, "What is least, worst class first"),
      std::map<std::string, CostKind>{{"count", CostKind::Count}, {"length", CostKind::ArcLength}});
  addChoice(group->add_option("--edges", planner.edges, "Which classes an edge counts for"),
            colored_graph::edgeModels());
  addChoice(
      group->add_option("--reading", planner.reading.kind, "What of a voxel's classes counts"),
      std::map<std::string, ClassReading::Kind>{{"likeliest", ClassReading::Kind::Likeliest},
                                                {"expected", ClassReading::Kind::Expected},
                                                {"cautious", ClassReading::Kind::Cautious}});
  group
      ->add_option("--bound", planner.reading.bound,
                   "cautious: the worst class above this probability counts; expected: none below")
      ->capture_default_str();
  planner.shorten = true;
  group->add_flag("!--as-found", planner.shorten,
                  "Leave the path as the graph has it; else detours over its vertices are cut off");
  group->add_option("--time-limit", planner.timeLimit, "Of the search, s");
}

void addGround(CLI::App& app, GroundOptions& ground) {
  auto* group = app.add_option_group("Ground");
  group
      ->add_option("--bridge-gap", ground.bridgeGap, "Holes up to this get their border's class, m")
      ->capture_default_str();
  group->add_option("--unknown-gap", ground.unknownGap, "Holes up to this are unknown ground, m")
      ->capture_default_str();
  group->add_flag("--keep-off", ground.keepFootprintOffForbidden,
                  "Keep the whole footprint off forbidden classes, not only the wheels");
}

}  // namespace

void Cli::addTo(CLI::App& app) {
  app.add_option("MAP", map, "A map's own file (.semantic)")->required();
  poses::addPose(app, "--start", start, "Where the vehicle is")->required();
  poses::addPose(app, "--goal", goal, "Where it is to go")->required();
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
  addRoadmap(app, planner.roadmap);
  addJudgment(app, planner);
  addGround(app, planner.ground);
}

}  // namespace semantic_map_plan
