#include <gtest/gtest.h>
#include <semantic_map/MapFiles.h>
#include <sys/stat.h>

#include <cmath>
#include <cstring>

#include "TemporaryFolder.h"

namespace {

/** An .ot file with one node, the root. */
std::string oneNode(float logOdds) {
  std::string bytes(sizeof logOdds + 1, '\0');  // the last byte: no children
  std::memcpy(bytes.data(), &logOdds, sizeof logOdds);
  return "# Octomap OcTree file\nid OcTree\nsize 1\nres 0.1\ndata\n" + bytes;
}

std::string errorReading(const std::filesystem::path& file) {
  const std::string error = errorOf([&] { semantic_map::importOctomapFile(file); });
  EXPECT_TRUE(error.empty() || contains(error, file.string() + ": ")) << error;
  return error;
}

}  // namespace

TEST(ImportOctomap, takesFilesWithFiniteLogOddsOnly) {
  const TemporaryFolder folder;
  const auto map = semantic_map::importOctomapFile(folder.write("a.ot", oneNode(0.5f)));
  ASSERT_TRUE(map.root());
  EXPECT_EQ(map.root().getLogOdds(), 0.5f);
  for (const float bad : {std::nanf(""), INFINITY, -INFINITY})
    EXPECT_TRUE(contains(errorReading(folder.write("a.ot", oneNode(bad))), "is not finite")) << bad;
  ASSERT_EQ(mkfifo((folder / "a.bt").c_str(), 0600), 0);
  EXPECT_TRUE(contains(errorReading(folder / "a.bt"), "it is no file, but a device or a pipe"));
}
