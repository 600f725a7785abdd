#pragma once
#include <labeled_cloud/LabelImage.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "Config.h"

namespace rawlog2semantic_map {

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
