#include <gtest/gtest.h>
#include <semantic_octree/TreeFile.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <cstring>
#include <sstream>

#include "PlainMap.h"
#include "RandomScans.h"
#include "TemporaryFolder.h"

using namespace semantic_octree;

namespace {

ClassTable classesWithFolds() {
  ClassTable classes;
  classes.add("road", {1, 2, 3});
  classes.add("Straße, naß", {255, 255, 255});
  for (int i = 3; i <= 5; ++i) classes.add("class " + std::to_string(i), {0, 0, 0});
  classes.fold(40, 1);
  classes.fold(4000000000u, 2);
  classes.fold(0, kNoClass);
  classes.setUnknownRawId(ClassTable::UnknownRawId::NoClass);
  return classes;
}

SemanticOcTree someTree(bool pruning = true, int numScans = 3, double resolution = 0.37) {
  FilterParameters parameters;
  parameters.accuracy = 0.71;
  parameters.labelCorrelation = 0.31;
  parameters.hitProbability = 0.62;
  parameters.falseAlarmProbability = 0.21;
  parameters.minOccupancy = 0.13;
  parameters.maxProbability = 0.95;
  parameters.softLabelFloor = 0.003;
  parameters.calibration = {0.6, 0.1};
  SemanticOcTree tree(resolution, classesWithFolds(), parameters);
  tree.setPruning(pruning);
  std::mt19937 random(1);
  for (int i = 0; i < numScans; ++i) {
    const PosedCloud scan = randomScan(random);
    for (int repeat = 0; repeat < 3; ++repeat) tree.insert(scan.cloud, scan.T_map_sensor);
  }
  return tree;
}

std::string bytesOf(const SemanticOcTree& tree) {
  std::ostringstream out;
  writeTree(out, tree);
  return out.str();
}

/** What loading a file with this content says. */
std::string loadError(const TemporaryFolder& folder, const std::string& content) {
  const std::string path = folder.write("bad.semantic", content).string();
  const std::string error = errorOf([&] { loadTree(path); });
  EXPECT_TRUE(error.empty() || contains(error, path)) << error;
  return error;
}

}  // namespace

TEST(TreeFile, bringsEveryBitBack) {
  const TemporaryFolder folder;
  for (const bool pruning : {true, false}) {
    const SemanticOcTree tree = someTree(pruning);
    saveTree(tree, folder / "map.semantic");
    const SemanticOcTree loaded = loadTree(folder / "map.semantic");
    EXPECT_TRUE(loaded == tree);
    EXPECT_EQ(loaded.size(), tree.size());
    EXPECT_EQ(loaded.pruning(), pruning);
    EXPECT_EQ(loaded.classes(), tree.classes());
    EXPECT_EQ(loaded.filterParameters(), tree.filterParameters());
    EXPECT_EQ(loaded.filterParameters().calibration.power, 0.6);
    EXPECT_EQ(loaded.filterParameters().calibration.shared, 0.1);
    EXPECT_EQ(loaded.getResolution(), tree.getResolution());
    EXPECT_EQ(bytesOf(loaded), bytesOf(tree));
  }
}

TEST(TreeFile, bringsEmptyMapsAndManyClassesBack) {
  for (const int classes : {1, 2, 3, 254}) {
    SemanticOcTree tree(0.1, numberedClasses(classes));
    std::stringstream stream;
    writeTree(stream, tree);
    EXPECT_TRUE(readTree(stream) == tree);
    RandomScanOptions options;
    options.classes = classes;
    std::mt19937 random(classes);
    const PosedCloud scan = randomScan(random, options);
    for (int i = 0; i < 5; ++i) tree.insert(scan.cloud, scan.T_map_sensor);
    writeTree(stream, tree);
    EXPECT_TRUE(readTree(stream) == tree);
  }
}

TEST(TreeFile, readsNoMoreThanItsOwnBytes) {
  const SemanticOcTree tree = someTree();
  std::stringstream stream;
  stream << "before";
  writeTree(stream, tree);
  writeTree(stream, tree);
  stream << "after";
  std::string word(6, ' ');
  stream.read(word.data(), 6);
  EXPECT_TRUE(readTree(stream) == tree);
  EXPECT_TRUE(readTree(stream) == tree);
  stream >> word;
  EXPECT_EQ(word, "after");
}

TEST(TreeFile, thatIsMissingOrNoFileIsRefusedByName) {
  const TemporaryFolder folder;
  const std::string path = folder / "map.semantic", begin = "cannot load map '" + path + "': ";
  EXPECT_EQ(errorOf([&] { loadTree(path); }), begin + "No such file or directory");
  EXPECT_TRUE(contains(errorOf([&] { loadTree(folder.path()); }), "folder"));
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_EQ(errorOf([&] { loadTree(path); }), begin + "it is no file, but a device or a pipe");
}

TEST(TreeFile, thatIsEmptyOrNoMapIsRefused) {
  const TemporaryFolder folder;
  EXPECT_TRUE(contains(loadError(folder, ""), "empty"));
  EXPECT_TRUE(contains(loadError(folder, "SEMO"), "truncated"));
  EXPECT_TRUE(
      contains(loadError(folder, "# Octomap OcTree file\nid OcTree\n"), "not a semantic octree"));
  EXPECT_TRUE(contains(loadError(folder, bytesOf(someTree()) + "x"), "after the end"));
}

TEST(TreeFile, ofAnUnknownVersionIsRefused) {
  const TemporaryFolder folder;
  std::string bytes = bytesOf(someTree());
  for (const char version : {0, 4, 6}) {
    bytes[8] = version;
    const std::string found = "version " + std::to_string(version);
    EXPECT_TRUE(contains(loadError(folder, bytes), found + " of the format, expected 5"));
  }
}

TEST(TreeFile, truncatedAnywhereIsRefused) {
  const TemporaryFolder folder;
  const std::string bytes = bytesOf(someTree(false, 4, 0.1));
  ASSERT_GT(bytes.size(), 65536u) << "several blocks";
  for (std::size_t length = 1; length < bytes.size();
       length += length < 300 || length + 300 > bytes.size() ? 1 : 997)
    ASSERT_TRUE(contains(loadError(folder, bytes.substr(0, length)), "truncated")) << length;
}

TEST(TreeFile, withAnyByteAlteredIsRefused) {
  std::string bytes = bytesOf(someTree(true, 1));
  for (std::size_t i = 0; i < bytes.size(); i += i < 500 || i + 100 > bytes.size() ? 1 : 311)
    for (const char flip : {'\x01', '\x80'}) {
      bytes[i] = static_cast<char>(bytes[i] ^ flip);
      std::istringstream in(bytes);
      ASSERT_THROW(readTree(in), std::runtime_error) << "byte " << i;
      bytes[i] = static_cast<char>(bytes[i] ^ flip);
    }
}

TEST(TreeFile, withBlocksExchangedIsRefused) {
  const TemporaryFolder folder;
  const std::string bytes = bytesOf(someTree(false, 6, 0.1));
  constexpr std::size_t begin = 12, block = 65536 + 8;
  ASSERT_GT(bytes.size(), begin + 2 * block);
  // Blocks are as full as whole values allow; find their lengths.
  std::uint32_t first = 0, second = 0;
  std::memcpy(&first, &bytes[begin], 4);
  std::memcpy(&second, &bytes[begin + 8 + first], 4);
  const std::string a = bytes.substr(begin, 8 + first),
                    b = bytes.substr(begin + 8 + first, 8 + second);
  const std::string rest = bytes.substr(begin + a.size() + b.size());
  EXPECT_EQ(loadError(folder, bytes.substr(0, begin) + a + b + rest), "");
  EXPECT_NE(loadError(folder, bytes.substr(0, begin) + b + a + rest), "");
  EXPECT_NE(loadError(folder, bytes.substr(0, begin) + a + rest), "");
  EXPECT_NE(loadError(folder, bytes.substr(0, begin) + a + b + b + rest), "");
}

TEST(TreeFile, thatCannotBeWrittenLeavesTheOldOneAlone) {
  const TemporaryFolder folder;
  const std::string nowhere = folder / "missing/map.semantic";
  const SemanticOcTree small = someTree(true, 1);
  EXPECT_EQ(errorOf([&] { saveTree(small, nowhere); }),
            "cannot save map '" + nowhere + "': cannot be written (does the folder exist?)");

  const std::string path = folder / "map.semantic";
  saveTree(small, path);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit tight = before;
  tight.rlim_cur = 4096;  // as a full disk
  signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &tight);
  const std::string error = errorOf([&] { saveTree(someTree(true, 3), path); });
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_TRUE(contains(error, "cannot save map '" + path + "'")) << error;
  EXPECT_TRUE(loadTree(path) == small);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(TreeFile, streamThatTakesNothingIsNoticed) {
  std::ostringstream out;
  out.setstate(std::ios::badbit);
  EXPECT_THROW(writeTree(out, someTree()), std::runtime_error);
}
