#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>

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
