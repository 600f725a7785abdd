#include <functional>
#include <iomanip>

#include "Application.h"
#include "Conversion.h"

namespace {

using namespace dataset2rawlog;

struct Cli {
  CLI::App app{"Turns data sets of scans into MRPT rawlogs."};
  Outputs outputs{app};
  Conversion conversion;
  std::string frames;
  std::filesystem::path source;
  std::vector<std::filesystem::path> pointFiles;
  std::string labelField = "label";
  BagChoice bag;
  std::function<Summary()> convert;

  Cli() {
    app.require_subcommand(1);
    app.set_help_all_flag("--help-all", "Print the help of all commands and exit");
    addSemanticKitti();
    addTum();
    addPcd();
    addCarmen();
#ifdef MSO_BAGS  // where SQLite and LZ4 are
    addRosbag2();
#endif
  }

 private:
  CLI::App* add(const std::string& name, const std::string& what, std::function<Summary()> action) {
    CLI::App* command = app.add_subcommand(name, what);
    outputs.add(*command, conversion.output, "FILE", "Rawlog to write")->required();
    command
        ->add_option("--frames", frames,
                     "Frames to take, counted from 0, LAST included (\"0:2:\": all even)")
        ->type_name("FIRST:STEP:LAST");
    command->callback([this, action] { convert = action; });
    return command;
  }

  void addLabelNoise(CLI::App* command) {
    command->add_option("--label-noise", conversion.labelNoise,
                        "Share of the labels to replace by other classes, 0 to 1");
    label_noise::addLabelNoiseKind(*command, conversion.labelNoiseKind);
    command->add_option("--seed", conversion.seed, "Seed of the label noise");
  }

  void addClasses(CLI::App* command) {
    command->add_option("--classes", conversion.classes, "Class table (YAML)");
    addLabelNoise(command);
  }

  void addNoLabels(CLI::App* command, const std::string& what) {
    command->add_flag("!--no-labels", conversion.labels, what);
  }

  void requireClasses() const {
    if (conversion.labels && conversion.classes.empty())
      throw CLI::RequiredError("--classes (except with --no-labels)");
  }

  void addSemanticKitti() {
    CLI::App* command = add("semantic-kitti", "A sequence of SemanticKITTI", [this] {
      requireClasses();
      return convertSemanticKitti(source, conversion);
    });
    addClasses(command);
    addNoLabels(command, "The scans without their labels");
    command->add_flag("--images", conversion.images, "Write the camera's images (image_2/), too");
    command->add_option("SEQUENCE_DIR", source, "Folder with velodyne/, labels/, calib.txt ...")
        ->required();
  }

  void addTum() {
    CLI::App* command =
        add("tum", "A TUM RGB-D sequence, with label images or --no-labels", [this] {
          requireClasses();
          return convertTumSequence(source, conversion);
        });
    addClasses(command);
    addNoLabels(command, "Depth and color only");
    command->add_option("DIR", source, "Folder with depth.txt, label.txt, groundtruth.txt ...")
        ->required();
  }

  void addPcd() {
    CLI::App* command = add("pcd", "PCD files with x, y, z and a label", [this] {
      return convertPointFiles(pointFiles, labelField, conversion);
    });
    addClasses(command);
    addNoLabels(command, "Points without labels");
    command->add_option("--label-field", labelField, "Field with the labels")
        ->type_name("NAME")
        ->capture_default_str();
    command->add_option("FILES", pointFiles, "The scans in order")->required();
  }

  void addCarmen() {
    CLI::App* command = add("carmen", "A log of CARMEN: laser scanners and odometry", [this] {
      conversion.labels = false;
      return convertCarmen(source, conversion);
    });
    command
        ->add_option("LOG", source,
                     "Log with lines FLASER, RLASER, RAWLASER1, ROBOTLASER1, ODOM, PARAM")
        ->required();
  }

#ifdef MSO_BAGS
  void addRosbag2() {
    CLI::App* command =
        add("rosbag2", "A bag of ROS 2: clouds, depth images, laser scans, and where the robot is",
            [this] {
              requireClasses();
              return convertRosbag2(source, bag, conversion);
            });
    command->add_option("--classes", conversion.classes, "Class table (YAML)");
    addNoLabels(command, "Points without labels");
    command
        ->add_option("--label-field", bag.labelField,
                     "The points' field with the labels; rgb: colors")
        ->type_name("NAME")
        ->capture_default_str();
    command
        ->add_option("--topics", bag.topics,
                     "Topics of clouds, depth images, laser scans, if there are several")
        ->type_name("NAME");
    command
        ->add_option("--label-images", bag.labelImages,
                     "Topic of the depth images' labels, if none has 'label' in its name, or a "
                     "folder of images named by time (12.250.png) or frame (000012.png)")
        ->type_name("NAME");
    command->add_option("BAG", source, "A file (.mcap, .db3), or a folder of these")->required();
  }
#endif
};

int run(Cli& cli) {
  const StopRequest stop("after this frame");
  cli.conversion.stop = &stop;
  if (!cli.frames.empty()) cli.conversion.frames = parseFrameRange(cli.frames);
  cli.outputs.check({cli.conversion.output});
  if (cli.conversion.images) cli.outputs.check({imagesOf(cli.conversion.output)});
  const Summary summary = cli.convert();
  notes() << cli.conversion.output.string() << ": " << summary.scans << " scans, " << summary.points
          << " points";
  if (cli.conversion.labels && summary.points > 0)
    notes() << ", " << std::fixed << std::setprecision(1)
            << 100.0 * summary.labeled / summary.points << " % with a class";
  notes() << "\n";
  if (summary.skipped > 0)
    notes() << summary.skipped << " frames skipped: no pose or no label image at their time\n";
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Cli cli;
  return runApplication(cli.app, argc, argv, [&] { return run(cli); });
}
