#include "Labels.h"

#include <labeled_cloud/NetworkLabeler.h>

#include <map>
#include <stdexcept>

namespace rawlog2semantic_map {

using labeled_cloud::ImageLabeler;
using labeled_cloud::LabelFolder;
using labeled_cloud::LabelImage;
using labeled_cloud::NetworkLabeler;
using semantic_types::ClassTable;

namespace {

/** A folder for each camera, or one for all that have none of their own. */
class FolderOfSensor : public ImageLabeler {
 public:
  void add(const std::string& source, const ClassTable& table, const Config& config) {
    const bool forAll = std::filesystem::exists(source) || source.find('=') == std::string::npos;
    const std::size_t split = forAll ? 0 : source.find('=');
    const std::string folder = source.substr(forAll ? 0 : split + 1);
    if (!m_folders.emplace(source.substr(0, split), LabelFolder(folder, table, config.labels))
             .second)
      throw std::runtime_error("--labels " + source + ": a second folder for the same sensor");
  }

  std::optional<LabelImage> label(const mrpt::obs::CObservation& observation) override {
    auto folder = m_folders.find(observation.sensorLabel);
    if (folder == m_folders.end()) folder = m_folders.find("");
    if (folder == m_folders.end()) return std::nullopt;
    return folder->second.label(observation);
  }

 private:
  /** By the sensor's label, "" for all others. */
  std::map<std::string, LabelFolder> m_folders;
};

}  // namespace

std::shared_ptr<ImageLabeler> makeLabeler(const LabelSources& sources, const ClassTable& table,
                                          const Config& config) {
  if (sources.network.empty() != sources.networkConfig.empty())
    throw std::runtime_error("--network and --network-config belong together");
  if (!sources.network.empty() && !sources.folders.empty())
    throw std::runtime_error("labels come from --labels or from --network, not from both");
  if (!sources.network.empty())
    return std::make_shared<NetworkLabeler>(
        sources.network, table.size(),
        labeled_cloud::loadNetworkOptions(sources.networkConfig, table));
  if (sources.folders.empty()) return nullptr;
  auto folders = std::make_shared<FolderOfSensor>();
  for (const std::string& source : sources.folders) folders->add(source, table, config);
  return folders;
}

}  // namespace rawlog2semantic_map
