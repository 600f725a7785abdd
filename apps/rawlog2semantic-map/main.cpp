// Makes a semantic octree map, pictures of it and a summary from labeled rawlogs.
#include <labeled_cloud/Rawlogs.h>
#include <labeled_cloud/Trajectory.h>
#include <map_operations/Calibrator.h>
#include <semantic_octree/TreeFile.h>
#include <semantic_types/ClassTable.h>
#include <strict_files/OutputFiles.h>
#include <strict_files/TextFile.h>
#include <strict_files/Words.h>

#include <optional>
#include <ostream>

#include "Application.h"
#include "Config.h"
#include "MapBuilder.h"
#include "ScanOutputs.h"
#include "inputs/Inputs.h"

namespace rawlog2semantic_map {
namespace {

namespace fs = std::filesystem;
using semantic_map::CSemanticOctoMap;
using semantic_octree::SemanticOcTree;
using semantic_types::ClassTable;
using strict_files::OutputFolder;

const std::vector<std::string> kFiles = {"map.semantic",  "summary.json",        "top.png",
                                         "view.png",      "compressed.semantic", "compressed.png",
                                         "trajectory.tum"};

struct Cli {
  fs::path config, output, trajectory, classes, confusion, saveLabeled, preview, reference;
  semantic_map::TFolderOptions folder;
  LabelSources labels;
  std::optional<double> resolution, maxRange;
  std::size_t previewEvery = 10;
  bool staticPose = false, slam = false, live = false, pause = false;
  std::vector<fs::path> rawlogs;
  Outputs outputs;

  explicit Cli(CLI::App& app) : outputs(app) { addTo(app); }
  bool estimatesConfusion() const { return confusion == "auto"; }
  /** \throw std::runtime_error naming a file that is there, or is an input. */
  void checkOutputs(const Config& settings) const {
    outputs.checkFolder(output, kFiles);
    outputs.checkFolder(preview, {Preview::nameOf(0)});
    outputs.check({saveLabeled}, {settings.map.classes});
  }

 private:
  void addTo(CLI::App& app) {
    app.add_option("--config", config,
                   "Options (.ini); without it, defaults, and the classes that the labels name");
    outputs.add(app, output, "FOLDER", "Folder of the results, created if need be")->required();
    addLabelsTo(app);
    auto* poses =
        app.add_option("--trajectory", trajectory,
                       "Poses of the robot, instead of those in the rawlog: TUM format, or "
                       "KITTI's (12 numbers a line, one line a scan)");
    auto* rest = app.add_flag("--static-pose", staticPose,
                              "The robot never moved: for rawlogs without poses")
                     ->excludes(poses);
    app.add_option("--classes", classes, "Class table (YAML), instead of the configuration's");
    app.add_option("--resolution", resolution, "Edge of a voxel, m")
        ->check(isNumber(strict_files::above(0)));
    app.add_option("--max-range", maxRange,
                   "Returns beyond it only carve free space, m; 0: no limit")
        ->check(isNumber(strict_files::atLeast(0)));
    app.add_flag_callback("-v,--verbose", beVerbose, "Say what became of each observation");
    auto* corrected = app.add_flag("--slam", slam,
                                   "Correct the poses: register scans to each other, close loops; "
                                   "for LiDARs, RGB-D cameras, laser scanners")
                          ->excludes(rest);
    app.add_option(
           "--reference", reference,
           std::string("Existing map (") + inputs::kMap + "): poses are corrected into its frame")
        ->needs(corrected);
    auto* window = app.add_flag(
        "--live", live,
        "Show the map in a window while it grows, and then until the window is closed");
    addTilesTo(app)->excludes(window);
    app.add_flag("--pause", pause, "Begin paused, before the first scan")->needs(window);
    app.add_option(
           "INPUT.rawlog", rawlogs,
           "Rawlogs: the parts of one log, in order. dataset2rawlog makes one of a ROS 2 bag")
        ->required();
  }

  CLI::Option* addTilesTo(CLI::App& app) {
    addOptions(app, strict_files::OptionList::of(folder.tiles), "Maps larger than memory");
    return app
        .add_option("--tiles", folder.folder,
                    "Folder of tiles for the map, added to what is there; "
                    "semantic-map-export draws it")
        ->type_name("FOLDER")
        ->group("Maps larger than memory");
  }

  void addLabelsTo(CLI::App& app) {
    app.add_option(
           "--labels", labels.folders,
           "Label images, instead of labels in the rawlog; given once for each camera, or for all")
        ->type_name("[SENSOR=]FOLDER")
        ->allow_extra_args(false);
    app.add_option("--network", labels.network, "Network (ONNX) that labels the color images");
    app.add_option("--network-config", labels.networkConfig,
                   "The network's input and output (YAML)");
    app.add_option("--confusion", confusion,
                   "Confusion matrix (YAML) of the classifier that gave the labels. auto: "
                   "estimate it from the drive, which is read twice");
    outputs.addOther(
        app.add_option("--save-labeled", saveLabeled, "Rawlog of the scans with their labels"));
    outputs.addOther(app.add_option("--preview", preview,
                                    "Folder for pictures: images with their labels and points")
                         ->type_name("FOLDER"));
    app.add_option("--preview-every", previewEvery, "Number of scans from one preview to the next")
        ->check(isNumber(strict_files::above(0)))
        ->capture_default_str();
  }
};

Config configOf(const Cli& cli) {
  Config config = cli.config.empty() ? Config() : loadConfig(cli.config);
  if (!cli.classes.empty()) config.map.classes = cli.classes.string();
  if (cli.resolution) config.map.resolution = *cli.resolution;
  if (cli.maxRange) config.insertion.scan.maxRange = *cli.maxRange;
  if (cli.live) config.stream.picturesEvery = 1;
  if (!cli.preview.empty()) config.stream.picturesEvery = cli.previewEvery;
  config.map.validate();
  config.insertion.validate();
  return config;
}

ClassTable classesOf(const Cli& cli, const Config& config) {
  if (!config.map.classes.empty()) return semantic_types::loadClassTable(config.map.classes);
  notes() << "Reading the labels' names" << std::endl;
  const ClassTable table = labeled_cloud::classesIn(cli.rawlogs);
  if (table.empty() && (!cli.labels.network.empty() || !cli.labels.folders.empty()))
    throw std::runtime_error("labels need a class table: --classes, or `classes` in --config");
  return table.empty() ? CSemanticOctoMap::occupancyOnly() : table;
}

/** \throw std::runtime_error naming the file of options and what is wrong. */
void setAbstraction(CSemanticOctoMap& map, const Cli& cli, const Config& config) try {
  map.setAbstraction(config.abstraction);
} catch (const std::exception& e) {
  const std::string table = config.map.classes.empty() ? "the rawlogs' labels" : config.map.classes;
  throw std::runtime_error(cli.config.string() + ": [abstraction] with the classes of " + table +
                           ": " + strict_files::messageOf(e));
}

/** Empty with --slam, if the rawlogs have none. */
labeled_cloud::Trajectory trajectoryOf(const Cli& cli) {
  if (cli.staticPose) return restAtOrigin();
  if (!cli.trajectory.empty()) return loadTrajectory(cli.trajectory, cli.rawlogs);
  notes() << "Reading the robot's poses" << std::endl;
  if (cli.slam) return labeled_cloud::findTrajectory(cli.rawlogs);
  return labeled_cloud::readTrajectory(
      cli.rawlogs, "give --trajectory or --slam, or --static-pose if the robot stood still");
}

/** The scans of rawlogs. */
struct Scans {
  /** Cli, table, settings and trajectory must outlive them. */
  Scans(const Cli& cli, const ClassTable& table, const Config& config,
        const labeled_cloud::Trajectory& trajectory)
      : labeler(makeLabeler(cli.labels, table, config)),
        converter(table, config.insertion.conversion, labeler),
        clouds(labeler, table.size(), config.insertion.conversion.labels, trajectory,
               config.cameras),
        stream(cli.rawlogs, converter, trajectory, labeler ? &clouds : nullptr, config.stream) {}

  std::shared_ptr<labeled_cloud::ImageLabeler> labeler;
  labeled_cloud::ScanConverter converter;
  labeled_cloud::CloudLabeler clouds;
  labeled_cloud::ScanStream stream;
};

/** \return null: no matrix */
std::shared_ptr<labeled_cloud::ConfusionMatrix> confusionOf(
    const Cli& cli, const ClassTable& table, const Config& config,
    const labeled_cloud::Trajectory& trajectory, const StopRequest& stop) {
  using labeled_cloud::ConfusionMatrix;
  if (cli.confusion.empty() || (cli.estimatesConfusion() && table.size() == 1)) return nullptr;
  if (!cli.estimatesConfusion())
    return std::make_shared<ConfusionMatrix>(
        labeled_cloud::loadConfusionMatrix(cli.confusion, table));
  if (cli.slam) throw std::runtime_error("--confusion auto needs poses that are right, not --slam");
  notes() << "Reading the labels that the confusion matrix follows from" << std::endl;
  Scans scans(cli, table, config, trajectory);
  semantic_octree::Calibrator labels(config.map.resolution, table.size());
  while (const auto observation = stop.pending() ? std::nullopt : scans.stream.next())
    if (const auto& scan = observation->scan)
      labels.add(scan->cloud,
                 labeled_cloud::toEigen(observation->T_map_robot + scan->T_robot_sensor),
                 config.insertion.scan);
  return std::make_shared<ConfusionMatrix>(labels.confusion(config.insertion.filter.accuracy));
}

Summary buildMap(const Cli& cli, Config config, const StopRequest& stop, LiveScans* live,
                 CSemanticOctoMap& map, const OutputFolder& output) {
  const ClassTable& table = map.tree().classes();
  labeled_cloud::Trajectory trajectory = trajectoryOf(cli);
  const bool hasPoses = !trajectory.empty();
  if (!hasPoses) {
    notes() << "There are no poses: scans alone tell where the robot is" << std::endl;
    trajectory = restAtOrigin();
  }
  labeled_cloud::LabelModel& labels = config.insertion.conversion.labels;
  if (cli.estimatesConfusion()) labels.kind = labeled_cloud::LabelModel::Kind::Hard;
  labels.confusion = confusionOf(cli, table, config, trajectory, stop);
  if (labels.confusion) map.tree().setClassPrior(labels.confusion->classShares());
  Scans scans(cli, table, config, trajectory);
  std::optional<ScanLog> log;
  std::optional<Preview> preview;
  if (!cli.saveLabeled.empty()) log.emplace(cli.saveLabeled, table);
  if (!cli.preview.empty()) preview.emplace(cli.preview, table);
  MapBuilder builder(map, trajectory, [&](const auto& scan, const auto& T) {
    if (log) log->write(scan, T);
    if (preview) preview->write(scan);
    if (live) live->show(scan, T, builder.summary());
  });
  if (cli.trajectory.empty()) builder.countPoses();
  const fs::path trajectoryFile = output.staged("trajectory.tum");
  if (cli.slam) builder.correctPoses(config.slam, trajectoryFile.parent_path(), cli.reference);
  if (!hasPoses) builder.withoutOdometry();
  builder.insert(cli.rawlogs, scans.stream, stop);
  if (builder.summary().inserted == 0 && builder.summary().stopped)
    throw StoppedTooEarly("stopped before the first scan");
  if (builder.summary().inserted == 0)
    throw std::runtime_error("nothing to map: no observation was inserted, " +
                             builder.summary().skippedText());
  if (log) log->finish();
  if (cli.slam) strict_files::writeText(trajectoryFile, builder.trajectory());
  return builder.summary();
}

/** When all else has its place: OpenGL's library may end the process where memory is short.
 * \throw std::runtime_error naming the picture */
void drawView(const SemanticOcTree& tree, const Config& config, OutputFolder& output) try {
  map_pictures::savePicture(renderPerspective(tree, config.pictures, config.view),
                            output.staged("view.png"));
  output.commit({"view.png"});
} catch (const std::exception& e) {
  throw std::runtime_error("view.png: " + strict_files::messageOf(e));
}

void writeCompressed(CSemanticOctoMap& map, const Config& config, const OutputFolder& output) {
  const SemanticOcTree compressed = map.abstraction().compressedMap();
  saveTree(compressed, output.staged("compressed.semantic"));
  map_pictures::savePicture(renderTopView(compressed, config.pictures),
                            output.staged("compressed.png"));
}

/** Also its picture from above, and the compressed map. */
void writeMap(CSemanticOctoMap& map, const Config& config, const OutputFolder& output) {
  saveTree(map.tree(), output.staged("map.semantic"));
  if (config.abstraction.isSet()) writeCompressed(map, config, output);
  map_pictures::savePicture(renderTopView(map.tree(), config.pictures), output.staged("top.png"));
}

int run(const Cli& cli) {
  const StopRequest stop("after this observation");
  const Config config = configOf(cli);
  cli.checkOutputs(config);
  inputs::checkRawlogs(cli.rawlogs);
  const ClassTable table = classesOf(cli, config);
  CSemanticOctoMap map(config.map.resolution, table, config.insertion.filter);
  map.insertionOptions = config.insertion;
  const bool isInFolder = !cli.folder.folder.empty();
  isInFolder ? map.openFolder(cli.folder) : setAbstraction(map, cli, config);
  if (isInFolder && config.abstraction.isSet())
    notes() << "[abstraction] is left out with --tiles: semantic-map-compress compresses the folder"
            << std::endl;
  std::optional<LiveScans> live;
  if (cli.live) live.emplace(map.tree(), stop, cli.pause);
  OutputFolder output(cli.output);

  const Summary summary = buildMap(cli, config, stop, live ? &*live : nullptr, map, output);
  writeJson(output.staged("summary.json"), toJson(summary, map.tree(), !map.folder()));
  map.folder() ? map.folder()->save() : writeMap(map, config, output);
  output.commit(kFiles);
  const auto& tree = map.tree();
  if (!map.folder()) drawView(tree, config, output);
  notes() << cli.output.string() << ": voxels of " << tree.getResolution() << " m, "
          << tree.numClasses() << (tree.numClasses() == 1 ? " class, " : " classes, ")
          << tree.getNumLeafNodes() << " leaves, " << strict_files::sizeText(tree.memoryUsage())
          << " in memory" << std::endl;
  if (live) live->stay();
  return 0;
}

}  // namespace
}  // namespace rawlog2semantic_map

int main(int argc, char** argv) {
  CLI::App app("Makes a semantic octree map, pictures and a summary from labeled rawlogs");
  const rawlog2semantic_map::Cli cli(app);
  return runApplication(app, argc, argv, [&] { return rawlog2semantic_map::run(cli); });
}
