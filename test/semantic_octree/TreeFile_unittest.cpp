#include <gtest/gtest.h>
#include <semantic_octree/TreeFile.h>
#include <sys/stat.h>

#include <cmath>
#include <sstream>

#include "CraftedTreeFile.h"
#include "FullDisk.h"
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

std::string fileOf(const SemanticOcTree& tree) {
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
    EXPECT_EQ(fileOf(loaded), fileOf(tree));
  }
}

TEST(TreeFile, bringsFactorsOfClassesBack) {
  SemanticOcTree tree = someTree();
  const std::string without = fileOf(tree);
  std::vector<double> factors(static_cast<std::size_t>(tree.numClasses()), 0.3);
  factors.back() = 7;
  tree.setCalibration({0.6, 0.1, factors});
  EXPECT_EQ(treeOf(fileOf(tree)).filterParameters().calibration.factors, factors);
  EXPECT_EQ(fileOf(treeOf(fileOf(tree))), fileOf(tree));
  tree.setCalibration({0.6, 0.1});
  EXPECT_EQ(fileOf(tree), without);
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
  EXPECT_TRUE(contains(loadError(folder, fileOf(someTree()) + "x"), "after the end"));
}

TEST(TreeFile, ofAnUnknownVersionIsRefused) {
  const TemporaryFolder folder;
  std::string bytes = fileOf(someTree());
  for (const char version : {0, 4, 6}) {
    bytes[8] = version;
    const std::string found = "version " + std::to_string(version);
    EXPECT_TRUE(contains(loadError(folder, bytes), found + " of the format, expected 5"));
  }
}

TEST(TreeFile, truncatedAnywhereIsRefused) {
  const TemporaryFolder folder;
  const std::string bytes = fileOf(someTree(false, 4, 0.1));
  ASSERT_GT(bytes.size(), 65536u) << "several blocks";
  for (std::size_t length = 1; length < bytes.size();
       length += length < 300 || length + 300 > bytes.size() ? 1 : 997)
    ASSERT_TRUE(contains(loadError(folder, bytes.substr(0, length)), "truncated")) << length;
}

TEST(TreeFile, withAnyByteAlteredIsRefused) {
  std::string bytes = fileOf(someTree(true, 1));
  for (std::size_t i = 0; i < bytes.size(); i += i < 500 || i + 100 > bytes.size() ? 1 : 311)
    for (const char flip : {'\x01', '\x80'}) {
      bytes[i] = static_cast<char>(bytes[i] ^ flip);
      std::istringstream in(bytes);
      ASSERT_THROW(readTree(in), std::runtime_error) << "byte " << i;
      bytes[i] = static_cast<char>(bytes[i] ^ flip);
    }
}

TEST(TreeFile, thatCannotBeWrittenLeavesTheOldOneAlone) {
  const TemporaryFolder folder;
  const std::string nowhere = folder / "missing/map.semantic";
  const SemanticOcTree small = someTree(true, 1);
  EXPECT_EQ(errorOf([&] { saveTree(small, nowhere); }),
            "cannot save map '" + nowhere + "': cannot be written (does the folder exist?)");

  const std::string path = folder / "map.semantic";
  saveTree(small, path);
  std::string error;
  {
    const FullDisk full(4096);
    error = errorOf([&] { saveTree(someTree(true, 3), path); });
  }
  EXPECT_TRUE(contains(error, "cannot save map '" + path + "'"));
  EXPECT_TRUE(loadTree(path) == small);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(TreeFile, streamThatTakesNothingIsNoticed) {
  std::ostringstream out;
  out.setstate(std::ios::badbit);
  EXPECT_THROW(writeTree(out, someTree()), std::runtime_error);
}

using u8 = std::uint8_t;
using u16 = std::uint16_t;
using i16 = std::int16_t;

// Files whose checksums are right and whose content is not.

/** What reading says. */
std::string error(const Header& header, const std::string& nodes = {}) {
  return errorOf([&] { treeOf(fileAround(header.bytes() + nodes)); });
}

std::string error(std::uint64_t numNodes, const std::string& nodes) {
  Header h;
  h.numNodes = numNodes;
  return error(h, nodes);
}

/** A map that is one block, at the lowest corner. \param numNodes without the 15 above it */
std::string errorOfBlock(std::uint64_t numNodes, const std::string& block) {
  std::string nodes = bytesOf(u8(3));
  for (int depth = 0; depth < 14; ++depth) nodes += bytesOf(u16(3));
  return error(15 + numNodes, nodes + block);
}

}  // namespace

TEST(CraftedTreeFile, ofSenselessHeadersIsRefused) {
  const auto with = [](auto change) {
    Header h;
    change(h);
    return h;
  };
  EXPECT_EQ(error({}), "");
  EXPECT_TRUE(contains(error(with([](Header& h) { h.resolution = -1; })), "resolution"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.resolution = NAN; })), "resolution"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.pruning = 2; })), "pruning"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.hasFactors = 7; })), "factors of classes"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.hasFactors = 1; })), "too early"));
  EXPECT_EQ(error(with([](Header& h) { h.hasFactors = 1, h.factors = {2, 0.5}; })), "");
  for (const double bad : {-1.0, 0.0, 1e9, static_cast<double>(NAN)})
    EXPECT_TRUE(contains(error(with([&](Header& h) {
                           h.hasFactors = 1, h.factors = {1, bad};
                         })),
                         "factors"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.accuracy = 3; })), "accuracy"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.minOccupancy = 1e-12; })), "min_occupancy"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.labelCorrelation = 1.01; })), "correlation"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.power = 0; })), "calibration.power"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.shared = 1; })), "calibration.shared"));
  EXPECT_EQ(error(with([](Header& h) { h.halfLife = 2, h.clock = 5; })), "");
  EXPECT_TRUE(contains(error(with([](Header& h) { h.clock = 5; })), "a clock that cannot be"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.clock = -5; })), "a clock that cannot be"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.names = {}; })), "number of classes"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.names = {"a", "a"}; })), "two classes"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.policy = 2; })), "unknown raw id"));
  EXPECT_TRUE(contains(error(with([](Header& h) { h.numFolds = 4000000000u; })), "altered"));
  EXPECT_TRUE(contains(error({}, "more"), "more content"));
}

TEST(CraftedTreeFile, ofClassNamesWithControlCharactersIsRefused) {
  Header h;
  h.names = {"road\n!touch x\n", "b"};
  EXPECT_TRUE(contains(error(h), "the name of class 1, 'road\\x0a!touch x\\x0a'"));
}

TEST(CraftedTreeFile, ofBrokenNodesIsRefused) {
  const i16 half = 512, most = 32767, none = -32768;
  EXPECT_EQ(error(1, bytesOf(u8(1), most)), "");
  EXPECT_EQ(error(2, bytesOf(u8(3), u16(1), half)), "");
  EXPECT_EQ(error(1, bytesOf(u8(2), half, u8(1), half, u8(2), i16(-most))), "");
  EXPECT_TRUE(contains(error(1, ""), "ends too early"));
  EXPECT_TRUE(contains(error(1, bytesOf(u8(0))), "no root"));
  EXPECT_TRUE(contains(error(1, bytesOf(u8(4))), "node kind"));
  EXPECT_TRUE(contains(error(1, bytesOf(u8(1), none)), "out of range"));
  EXPECT_TRUE(contains(error(1, bytesOf(u8(2), half, u8(0), none)), "out of range"));
  EXPECT_TRUE(contains(error(1, bytesOf(u8(2), half, u8(1), half, u8(1), none)), "out of range"));
  EXPECT_TRUE(contains(error(1, bytesOf(u8(3), u16(0))), "without children"));
  EXPECT_TRUE(contains(error(3, bytesOf(u8(3), u16(1), half)), "2 nodes, expected 3"));
  EXPECT_TRUE(contains(error(~0ull, bytesOf(u8(3), u16(1), half)), "nodes, expected"));
  const auto record = [&](u8 count, u8 id, u8 second) {
    return bytesOf(u8(2), half, count, half, id, half, second, half);
  };
  EXPECT_EQ(error(1, record(2, 1, 2)), "");
  EXPECT_TRUE(contains(error(1, record(3, 1, 2)), "named classes = 3"));
  EXPECT_TRUE(contains(error(1, record(2, 1, 3)), "class = 3"));
  EXPECT_TRUE(contains(error(1, record(2, 0, 1)), "class 0 in a class record"));
  EXPECT_TRUE(contains(error(1, record(2, 2, 2)), "class 2 twice"));
}

TEST(CraftedTreeFile, ofBlocksThatCannotBeIsRefused) {
  const i16 a = 100, b = -200;
  // Octant 0 is a leaf, of octant 5 voxels 1 and 7 are known, the latter has a record.
  EXPECT_EQ(errorOfBlock(4, bytesOf(u8(0x21), u8(1), u8(0), u8(0x82), u8(0x80), a, b, a, u8(0), b)),
            "");
  EXPECT_EQ(errorOfBlock(1, bytesOf(u8(1), u8(1), u8(1), a, u8(0), b)), "");
  EXPECT_TRUE(contains(errorOfBlock(2, bytesOf(u8(1), u8(1), u8(0), a)), "16 nodes, expected 17"));
  EXPECT_TRUE(contains(errorOfBlock(1, bytesOf(u8(1), u8(1), u8(1), a)), "ends too early"));
  EXPECT_TRUE(contains(errorOfBlock(1, bytesOf(u8(1), u8(1), u8(0), i16(-32768))), "out of range"));
  const auto cannotBe = [](const std::string& block) {
    return contains(errorOfBlock(1, block), "a block that cannot be");
  };
  EXPECT_TRUE(cannotBe(bytesOf(u8(0), u8(0), u8(0)))) << "nothing is known";
  EXPECT_TRUE(cannotBe(bytesOf(u8(1), u8(2), u8(0), a))) << "a leaf that is not known";
  EXPECT_TRUE(cannotBe(bytesOf(u8(3), u8(1), u8(2), a))) << "a leaf's record without the leaf";
  EXPECT_TRUE(cannotBe(bytesOf(u8(1), u8(0), u8(0), u8(0), u8(0)))) << "an octant without voxels";
  EXPECT_TRUE(cannotBe(bytesOf(u8(1), u8(0), u8(0), u8(1), u8(2), a, u8(0), b)))
      << "a record without its voxel";
}

TEST(CraftedTreeFile, holdsWhatItsBlocksSay) {
  Header h;
  h.numNodes = 19;
  std::string nodes = bytesOf(u8(3));
  for (int depth = 0; depth < 14; ++depth) nodes += bytesOf(u16(3));
  nodes += bytesOf(u8(0x21), u8(1), u8(1), u8(0x82), u8(0x80));
  nodes += bytesOf(i16(1024), i16(-512), i16(512));       // octant 0; octant 5, voxels 1 and 7
  nodes += bytesOf(u8(1), i16(-1024), u8(2), i16(2048));  // record of octant 0
  nodes += bytesOf(u8(0), i16(-3));                       // and of the last voxel
  const SemanticOcTree tree = treeOf(fileAround(h.bytes() + nodes));
  const auto leaf = tree.search({1, 0, 1}), other = tree.search({3, 0, 2}),
             last = tree.search({3, 1, 3});
  EXPECT_EQ(leaf, tree.search({0, 0, 0}, 15));
  EXPECT_EQ(leaf.getLogOdds(), 1);
  EXPECT_EQ(tree.belief(leaf).ids[0], 2);
  EXPECT_EQ(tree.belief(leaf).logOdds[0], 2);
  EXPECT_EQ(tree.belief(leaf).rest, -1);
  EXPECT_EQ(other.getLogOdds(), -0.5);
  EXPECT_FALSE(other.hasClassRecord());
  EXPECT_EQ(last.getLogOdds(), 0.5);
  EXPECT_EQ(tree.belief(last).rest, -3 / 1024.f);
  EXPECT_EQ(tree.root().getLogOdds(), 1);
  for (const octomap::OcTreeKey& key : {octomap::OcTreeKey(2, 0, 2), {0, 2, 0}, {4, 0, 0}})
    EXPECT_FALSE(tree.search(key));
}
