#pragma once
#include <labeled_cloud/CloudLabeler.h>
#include <labeled_cloud/LabelImage.h>
#include <labeled_cloud/ScanStream.h>
#include <labeled_cloud/Trajectory.h>
#include <map_pictures/MapPictures.h>
#include <semantic_map/MapOptions.h>
#include <semantic_slam/SlamOptions.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace rawlog2semantic_map {

/** Holds at all times. */
labeled_cloud::Trajectory restAtOrigin();

/** Poses of a file in the TUM format (see labeled_cloud::loadTumTrajectory()) or in KITTI's. The
 * latter has 3x4 matrices [R|t] in rows of twelve numbers: T_map_robot at each of the rawlogs'
 * scans, in the order of their times.
 * \throw std::runtime_error naming the file, and the line: it is neither, or has another number of
 * poses than there are scans. */
labeled_cloud::Trajectory loadTrajectory(const std::filesystem::path& file,
                                         const std::vector<std::filesystem::path>& rawlogs);

/** What the .ini file says: one member a section. */
struct Config {
  semantic_map::TCreationOptions map;             // [map]
  semantic_map::TInsertionOptions insertion;      // [insertion]; its label model is in [labels]
  semantic_map::TAbstractionOptions abstraction;  // [abstraction]
  labeled_cloud::LabelFolderOptions labels;       // [labels]
  labeled_cloud::ScanStreamOptions stream;        // [labels] too
  labeled_cloud::CloudLabelerOptions cameras;     // [cameras] and [camera NAME]
  semantic_slam::SlamOptions slam;                // [slam]
  map_pictures::PictureStyle pictures;            // [pictures]
  map_pictures::Viewpoint view;                   // [pictures] too
};

/** Reads the file; `map.classes` is then relative to the working directory, not to the file.
 * \throw std::runtime_error naming the file, and section, key and value where they are to blame.
 * Causes: unreadable, an unknown section or key, a value that cannot be read or is out of range. */
Config loadConfig(const std::filesystem::path& file);

/** Where labels come from, if not from the observations themselves. */
struct LabelSources {
  /** Folders of label images: "FOLDER" for all sensors, "SENSOR=FOLDER" for one. */
  std::vector<std::string> folders;
  std::filesystem::path network, networkConfig;
};

/** What finds the label images; null without any source.
 * \throw std::runtime_error naming what is missing or wrong: an option, a folder, a file. */
std::shared_ptr<labeled_cloud::ImageLabeler> makeLabeler(const LabelSources& sources,
                                                         const semantic_types::ClassTable& table,
                                                         const Config& config);

}  // namespace rawlog2semantic_map
