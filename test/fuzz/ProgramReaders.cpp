#include <CLI/CLI.hpp>
#include <sstream>

#include "Application.h"
#include "FuzzedFile.h"
#include "Readers.h"
#include "dataset2rawlog/Conversion.h"
#include "point_fields/PointFields.h"
#include "poses/Poses.h"
#include "rawlog2semantic-map/Config.h"
#include "semantic-map-info/PointQuery.h"
#include "semantic-map-ros2/Parameters.h"
#include "semantic-map-view/Track.h"
#include "simulated_drive/DriveConfig.h"

namespace {

namespace fs = std::filesystem;

dataset2rawlog::Conversion conversionTo(const fs::path& folder) {
  dataset2rawlog::Conversion conversion;
  conversion.output = folder / "out.rawlog";
  return conversion;
}

void readKitti(const fs::path& folder) {
  dataset2rawlog::Conversion conversion = conversionTo(folder);
  conversion.classes = folder / "classes.yaml";
  dataset2rawlog::convertSemanticKitti(folder, conversion);
}

void readTum(const fs::path& folder) {
  dataset2rawlog::Conversion conversion = conversionTo(folder);
  conversion.labels = false;
  dataset2rawlog::convertTumSequence(folder, conversion);
}

void readPcd(const fs::path& folder) {
  dataset2rawlog::convertPointFiles({folder / "a.pcd"}, "label", conversionTo(folder));
}

void readCarmen(const fs::path& log) {
  const Removed folder(fuzzedPath(".d"));
  fs::create_directories(folder.path());
  dataset2rawlog::convertCarmen(log, conversionTo(folder.path()));
}

/** Beside the files that it names. */
void readDrive(const fs::path& folder) {
  for (const char* name : {"classes", "reactive", "vehicles"})
    fs::create_directory_symlink(fs::path(MSO_SOURCES "/config") / name, folder / name);
  simulated_drive::loadDriveConfig(folder / "drives/drive.ini");
}

#ifdef MSO_BAGS
void readBag(const fs::path& bag) {
  const Removed folder(fuzzedPath(".out"));
  fs::create_directories(folder.path());
  dataset2rawlog::Conversion conversion = conversionTo(folder.path());
  conversion.labels = false;
  dataset2rawlog::convertRosbag2(bag, {}, conversion);
}
#endif

void askMap(const std::string& bytes) {
  static const semantic_octree::SemanticOcTree map = [] {
    semantic_types::ClassTable table;
    table.add("road", {});
    semantic_octree::SemanticOcTree tree(0.5, table);
    semantic_types::LabeledCloud cloud;
    cloud.points = {{1, 2, 3}};
    cloud.classes = {1};
    tree.insert(cloud, Eigen::Isometry3d::Identity());
    return tree;
  }();
  const auto answers = semantic_map_info::answersAt(map, strict_files::linesOf(bytes, "-"), true);
  semantic_map_info::textOfAnswers(answers);
  answers.dump();
}

/** A program with options of all kinds; each line of the bytes is a word. */
void parseCommandLine(const std::string& bytes) {
  semantic_planning::PlannerOptions planner;
  semantic_octree::InsertionOptions insertion;
  mrpt::math::TPose2D start;
  fs::path input, output;
  CLI::App app("Reads words", "program");
  Outputs outputs(app);
  outputs.add(app, output, "FILE", "File to write");
  app.add_option("INPUT", input);
  poses::addPose(app, "--start", start, "Where it begins");
  addOptions(app, strict_files::OptionList::of(planner), "Planning");
  addOptions(app, strict_files::OptionList::of(insertion), "Insertion");
  makeHelpReadable(app);

  std::vector<std::string> words;
  std::istringstream in(bytes);
  for (std::string word; std::getline(in, word);) words.insert(words.begin(), word);
  try {
    app.parse(words);
    planner.validate();
    insertion.validate();
  } catch (const CLI::ParseError& e) {
    std::ostringstream out;
    if (e.get_exit_code() == 0) app.exit(e, out, out);
    throw std::runtime_error("program: " + problemOf(app, e));
  }
}

/** A cloud's message: the number of fields (name, offset, type), sizes, and what is left as data.
 */
void readPointFields(const std::string& bytes) {
  std::size_t at = 0;
  const auto number = [&](std::size_t size) {
    std::uint32_t n = 0;
    for (; size > 0; --size) n = n << 8 | (at < bytes.size() ? std::uint8_t(bytes[at++]) : 0);
    return n;
  };
  const std::vector<std::string> names = {"x", "y", "z", "label", "rgb", "t"};
  point_fields::RawCloud raw;
  for (std::uint32_t fields = number(1) % 8; fields > 0; --fields) {
    const std::string name = names[number(1) % names.size()];
    const std::uint32_t offset = number(4);
    raw.fields.push_back({name, offset, static_cast<int>(number(1))});
  }
  raw.width = number(4), raw.height = number(4), raw.pointStep = number(4), raw.rowStep = number(4);
  raw.isBigEndian = number(1) % 2 == 1;
  const std::vector<std::uint8_t> data(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                                       bytes.end());
  raw.data = data.data(), raw.size = data.size();
  for (const char* field : {"label", "rgb"}) {
    std::string problem;
    point_fields::cloudOf(raw, field, fuzzedClasses(), problem);
    point_fields::timesOf(raw, 1);
  }
}

}  // namespace

std::vector<Reader> programReaders() {
  return {
      {"carmen", fromFile("", readCarmen), {}},
      {"pcd", fromFolder({"a.pcd"}, readPcd), {}},
      {"kitti",
       fromFolder({"calib.txt", "poses.txt", "times.txt", "classes.yaml", "velodyne/000000.bin",
                   "labels/000000.label"},
                  readKitti),
       {}},
      {"tum", fromFolder({"camera.ini", "groundtruth.txt", "depth.txt", "depth.png"}, readTum), {}},
      {"queries", askMap, {}},
      {"path", fromFile(".csv", [](const fs::path& f) { semantic_map_view::readTrack(f); }), {}},
      {"mapping-config",
       fromFile("", rawlog2semantic_map::loadConfig),
       {"config/maps/synthetic.ini"}},
      {"drive-config",
       fromFolder({"drives/drive.ini"}, readDrive),
       {"config/drives/synthetic.ini"}},
      {"ros-parameters",
       fromFile("", [](const fs::path& f) { semantic_map_ros2::readParameters({f}, {}); }),
       {"config/ros/semantic-map-ros2.yaml"}},
      {"point-fields", readPointFields, {}},
#ifdef MSO_BAGS
      {"mcap", fromFile(".mcap", readBag), {}},
      {"sqlite-bag", fromFile(".db3", readBag), {}},
#endif
      {"command-line", parseCommandLine, {}}};
}
