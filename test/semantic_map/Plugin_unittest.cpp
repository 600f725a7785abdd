#include <gtest/gtest.h>
#include <map_folders/MapFolder.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt_compat/Release.h>

#include <cstdlib>

#include "RunProgram.h"
#include "ShellCommand.h"
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

TEST(Plugin, observations2mapMakesAMapOfASimpleMap) {
  if (MSO_MRPT_AT_LEAST(3, 0, 0)) GTEST_SKIP() << "Debian's programs are built with MRPT 2";
  if (std::system("command -v observations2map >/dev/null") != 0)
    GTEST_SKIP() << "needs observations2map (Debian package mrpt-apps)";
  const TemporaryFolder folder;
  mrpt::maps::CSimpleMap observations;
  const auto frame = mrpt::obs::CSensoryFrame::Create();
  frame->insert(
      labeled_cloud::CObservationLabeledCloud::Create(labeledPoints({{3.05f, 0.05f, 0.05f}}, {1})));
  const mrpt::poses::CPose3D T_map_robot(1, 2, 0, 0, 0, 0);
  observations.insert(mrpt::poses::CPose3DPDFGaussian::Create(T_map_robot), frame);
  ASSERT_TRUE(observations.saveToFile((folder / "in.simplemap").string()));
  const auto ini = folder.write("map.ini",
                                "[Maps]\nsemanticOctoMap_count = 1\n"
                                "[Maps_semanticOctoMap_00_creationOpts]\nresolution = 0.2\n");

  const std::string output = runCommand("LD_PRELOAD=" + kPlugin + " observations2map " +
                                        ini.string() + " " + (folder / "in.simplemap").string() +
                                        " " + (folder / "out").string() + " -s Maps </dev/null")
                                 .output;
  std::string found;
  for (const auto& file : std::filesystem::directory_iterator(folder.path()))
    if (file.path().extension() == ".semantic") found = file.path().string();
  ASSERT_FALSE(found.empty()) << output;
  const auto tree = semantic_octree::loadMap(found);
  EXPECT_EQ(tree.getResolution(), 0.2);
  EXPECT_EQ(tree.query(4.05, 2.05, 0.05).status, semantic_octree::CellState::Status::Occupied);
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
    const ProgramRun host = runProgram(
        PLUGIN_HOST, {kPlugin, (folder / (name + ".ini")).string(), (folder / name).string()});
    EXPECT_EQ(host.status, 0) << host.errors;
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
