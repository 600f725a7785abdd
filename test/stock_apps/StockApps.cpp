#include "StockApps.h"

#include <mrpt/obs/CRawlog.h>
#include <semantic_octree/TreeFile.h>

namespace fs = std::filesystem;

const std::string StockApps::kPlugin = std::string(MSO_LIB_DIR) + "/libmrpt_semantic_octree.so";

StockApps::StockApps() {
  for (const char* name : {"config", "rawlog-samples"})
    fs::create_directory_symlink(fs::path(MSO_SOURCE_DIR) / name, folder / name);
}

CommandRun StockApps::run(const std::string& command, Plugin plugin) const {
  const std::string environment =
      plugin == Plugin::Preloaded ? "LD_PRELOAD='" + kPlugin + "' " : std::string();
  folder.write("command", "cd '" + folder.path().string() + "'\nexport HOME=\"$PWD\"\n" +
                              environment + command + "\n");
  return runCommand("timeout 200 sh '" + (folder / "command").string() + "'");
}

std::optional<semantic_octree::SemanticOcTree> StockApps::mapIn(
    const std::string& subfolder) const {
  if (!fs::exists(folder / subfolder)) return std::nullopt;
  for (const auto& file : fs::recursive_directory_iterator(folder / subfolder))
    if (file.path().extension() == ".semantic")
      return semantic_octree::loadTree(file.path().string());
  return std::nullopt;
}

std::string StockApps::shortRawlog(const std::string& dataset, std::size_t pairs) const {
  using Entry = mrpt::obs::CRawlog::TEntryType;
  mrpt::obs::CRawlog rawlog, first;
  EXPECT_TRUE(rawlog.loadFromRawLogFile("/usr/share/mrpt/datasets/" + dataset));
  for (std::size_t entry = 0; pairs > 0; ++entry) {
    const auto type = rawlog.getType(entry);
    if (type == Entry::etActionCollection) first.insert(rawlog.getAsAction(entry));
    if (type != Entry::etSensoryFrame) continue;
    first.insert(rawlog.getAsObservations(entry));
    --pairs;
  }
  const std::string file = (folder / "short.rawlog").string();
  EXPECT_TRUE(first.saveToRawLogFile(file));
  return file;
}

std::string StockApps::configWith(const std::string& name, const std::string& section,
                                  const std::string& line) const {
  std::string text;
  std::ifstream in(folder / ("config/stock-apps/" + name));
  text.assign(std::istreambuf_iterator<char>(in), {});
  const std::string head = "[" + section + "]\n";
  const std::size_t place = text.find(head);
  if (place == std::string::npos)
    text += "\n" + head + line + "\n";
  else
    text.insert(place + head.size(), line + "\n");
  return folder.write(name, text).string();
}
