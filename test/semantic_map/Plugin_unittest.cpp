#include <gtest/gtest.h>
#include <map_folders/MapFolder.h>

#include "RunProgram.h"
#include "SmallMaps.h"
#include "TemporaryFolder.h"

namespace {

const std::string kPlugin = std::string(MSO_LIB_DIR) + "/libmrpt_semantic_octree.so";

}  // namespace

TEST(Plugin, loadsIntoAProgramThatDoesNotKnowIt) {
  const std::string expected = "semantic_map::CSemanticOctoMap is filled\n";
  EXPECT_EQ(runCommand(PLUGIN_HOST " " + kPlugin).output, expected);
  EXPECT_EQ(runCommand("LD_PRELOAD=" + kPlugin + " " PLUGIN_HOST).output, expected);
}

TEST(Plugin, withoutItTheMapIsUnknown) {
  const std::string output = runCommand(PLUGIN_HOST).output;
  EXPECT_FALSE(contains(output, "is filled")) << output;
}

TEST(Plugin, mapsInAFolderWithinItsBudgetWhatItMapsInMemory) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer takes memory of its own";
#endif
  const TemporaryFolder folder;
  const std::string memory =
      "[M]\nsemanticOctoMap_count = 1\n[M_semanticOctoMap_00_creationOpts]\nresolution = 0.2\n"
      "enableSaveAs3DObject = false\n";
  folder.write("memory.ini", memory);
  folder.write("folder.ini", memory +
                                 "[M_semanticOctoMap_00_folderOpts]\nmemory = 2\n"
                                 "tile_size = 12.8\nfolder = " +
                                 (folder / "tiles").string() + "\n");
  const auto run = [&](const std::string& name) {
    const ProgramRun host = succeeded(runProgram(
        PLUGIN_HOST, {kPlugin, (folder / (name + ".ini")).string(), (folder / name).string()}));
    return host;
  };
  const ProgramRun inMemory = run("memory"), inFolder = run("folder");
  EXPECT_EQ(inFolder.output, inMemory.output);
  std::size_t saved = 0;
  std::string map;
  for (const auto& file : std::filesystem::directory_iterator(folder.path()))
    if (file.path().extension() == ".semantic") map = file.path().string(), ++saved;
  ASSERT_EQ(saved, 1u);
  const auto tree = semantic_octree::loadMap(map);
  EXPECT_TRUE(semantic_octree::loadMap((folder / "tiles").string()) == tree);
  const double kilobytes = double(tree.memoryUsage()) / 1e3;
  EXPECT_GT(kilobytes, 10000);
  EXPECT_LT(double(inFolder.peakKilobytes), double(inMemory.peakKilobytes) - 0.7 * kilobytes);
}
