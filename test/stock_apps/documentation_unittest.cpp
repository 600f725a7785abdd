#include <regex>
#include <sstream>

#include "StockApps.h"

namespace {

/** The shell commands of a page, as one script: what stands between "```console" and "```".
 * Commands that other tests of this folder run, for they take long or need a display, are left out.
 */
std::string commandsOf(const std::filesystem::path& page) {
  static const std::regex elsewhere("^(RawLogViewer|SceneViewer3D|LD_PRELOAD=.* rbpf-slam) ");
  std::ifstream in(page);
  std::string script = "set -e\n";
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("```", 0) == 0)
      inside = line == "```console";
    else if (inside && !std::regex_search(line, elsewhere))
      script += line + "\n";
  }
  return script;
}

}  // namespace

TEST_F(StockApps, theCommandsOfTheirPageWorkOneAfterTheOther) {
  SKIP_WITHOUT_APP("icp-slam");
  SKIP_WITHOUT(std::string("/usr/share/mrpt/datasets/") + kLaserRawlog, "mrpt-common");
  std::filesystem::create_directory(folder / "build");
  std::filesystem::create_directory_symlink(MSO_LIB_DIR, folder / "build/lib");
  std::filesystem::create_directory_symlink(MSO_BIN_DIR, folder / "build/bin");
  folder.write("page.sh", commandsOf(MSO_SOURCE_DIR "/doc/handbook/stock-applications.md"));
  const ProgramRun read = run("sh page.sh");
  EXPECT_EQ(read.status, 0) << read.output;
  for (const char* made :
       {"icp-slam-output/_finalmaps_.txt_semantic_map__CSemanticOctoMap_01.semantic",
        "from-keyframes_semantic_map__CSemanticOctoMap_00.3Dscene",
        "pf-localization-output_000_0005000/map_semantic_map__CSemanticOctoMap_00.semantic",
        "short.rawlog", "lidar.rawlog"})
    EXPECT_TRUE(std::filesystem::exists(folder / made)) << made;
}
