#include <gtest/gtest.h>

#include "RunProgram.h"
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
