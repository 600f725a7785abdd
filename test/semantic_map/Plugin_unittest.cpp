#include <gtest/gtest.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <semantic_octree/TreeFile.h>

#include <array>
#include <cstdio>
#include <cstdlib>

#include "SmallMaps.h"
#include "TemporaryFolder.h"

namespace {

const std::string kPlugin = std::string(MSO_LIB_DIR) + "/libmrpt_semantic_octree.so";

/** What a shell command prints on both outputs. */
std::string outputOf(const std::string& command) {
  std::string output;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::array<char, 256> buffer;
  while (const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe))
    output.append(buffer.data(), n);
  pclose(pipe);
  return output;
}

}  // namespace

TEST(Plugin, loadsIntoAProgramThatDoesNotKnowIt) {
  const std::string expected = "semantic_map::CSemanticOctoMap is filled\n";
  EXPECT_EQ(outputOf(PLUGIN_HOST " " + kPlugin), expected);
  EXPECT_EQ(outputOf("LD_PRELOAD=" + kPlugin + " " PLUGIN_HOST), expected);
}

TEST(Plugin, withoutItTheMapIsUnknown) {
  const std::string output = outputOf(PLUGIN_HOST);
  EXPECT_FALSE(contains(output, "is filled")) << output;
}

TEST(Plugin, observations2mapMakesAMapOfASimpleMap) {
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

  const std::string output = outputOf("LD_PRELOAD=" + kPlugin + " observations2map " +
                                      ini.string() + " " + (folder / "in.simplemap").string() +
                                      " " + (folder / "out").string() + " -s Maps </dev/null");
  std::string found;
  for (const auto& file : std::filesystem::directory_iterator(folder.path()))
    if (file.path().extension() == ".semantic") found = file.path().string();
  ASSERT_FALSE(found.empty()) << output;
  const auto tree = semantic_octree::loadTree(found);
  EXPECT_EQ(tree.getResolution(), 0.2);
  EXPECT_EQ(tree.query(4.05, 2.05, 0.05).status, semantic_octree::CellState::Status::Occupied);
}
