// A map in a folder of tiles is the map that it would be in memory, to the last bit.
#include <gtest/gtest.h>
#include <map_folders/MapFolder.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <semantic_octree/TreeFile.h>
#include <sys/resource.h>
#include <atomic>
#include <thread>

#include "SmallMaps.h"
#include "TemporaryFolder.h"

using mrpt::poses::CPose3D;
using semantic_map::CSemanticOctoMap;

namespace {

semantic_map::TFolderOptions tilesIn(const std::filesystem::path& folder, bool readOnly = false) {
  semantic_map::TFolderOptions options;
  options.folder = folder.string();
  options.readOnly = readOnly;
  options.tiles.memory = 0.002;  // MB: nearly nothing stays
  options.tiles.tileSize = 1.6;
  return options;
}

CSemanticOctoMap empty() {
  CSemanticOctoMap map(0.1, threeClasses());
  map.likelihoodOptions.decimation = 1;
  map.likelihoodOptions.beamStep = 0.3;
  return map;
}

/** A map in memory, and the same one in a folder. */
class InFolder : public testing::Test {
 protected:
  InFolder() : plain(empty()), owner(std::make_unique<CSemanticOctoMap>(empty())), map(*owner) {
    fill(plain);
    map.openFolder(tilesIn(folder / "tiles"));
    fill(map);
  }

  const TemporaryFolder folder;
  CSemanticOctoMap plain;
  std::unique_ptr<CSemanticOctoMap> owner;
  CSemanticOctoMap& map;
};

std::string treeOf(const CSemanticOctoMap& map) {
  std::ostringstream out;
  writeTree(out, map.tree());
  return out.str();
}

std::vector<double> likelihoodsOf(const CSemanticOctoMap& map) {
  const auto scan = labeledPoints({{4, 1, 0}, {-2, 3, 0.5f}, {0, -4, 1}, {1, 1, 1}}, {1, 2, 3, 0});
  std::vector<double> answers;
  for (double x = -1; x < 1; x += 0.11)
    answers.push_back(map.computeObservationLikelihood(scan, CPose3D(x, 0, 0, x, 0, 0)));
  return answers;
}

std::vector<float> distancesOf(const CSemanticOctoMap& map) {
  std::vector<float> answers;
  for (float x = -6; x < 6; x += 1.37f)
    for (float y = -6; y < 6; y += 1.41f)
      answers.push_back(map.squareDistanceToClosestCorrespondence(x, y));
  return answers;
}

std::string drawingOf(const CSemanticOctoMap& map) { return bytesOf(*map.getVisualization()); }

/** No memory is left as long as it lives, as far as who asks before taking much can tell. */
class NoMemoryLeft {
 public:
  NoMemoryLeft() {
    getrlimit(RLIMIT_AS, &m_before);
    rlimit little = m_before;
    little.rlim_cur = 1 << 20;
    setrlimit(RLIMIT_AS, &little);
  }
  ~NoMemoryLeft() { setrlimit(RLIMIT_AS, &m_before); }

 private:
  rlimit m_before{};
};

}  // namespace

TEST_F(InFolder, answersAsInMemory) {
  EXPECT_TRUE(treeOf(map) == treeOf(plain));
  EXPECT_EQ(likelihoodsOf(map), likelihoodsOf(plain));
  EXPECT_EQ(distancesOf(map), distancesOf(plain));
  EXPECT_TRUE(drawingOf(map) == drawingOf(plain));
  EXPECT_EQ(map.boundingBox().min, plain.boundingBox().min);
  EXPECT_EQ(map.boundingBox().max, plain.boundingBox().max);
  const auto contents = map.folder()->contents();
  EXPECT_LT(contents.tilesInMemory, contents.tiles / 2);
  EXPECT_GT(contents.broughtIn, contents.tiles);
}

TEST_F(InFolder, isSavedThereAndNowhereElse) {
  map.saveMetricMapRepresentationToFile((folder / "saved").string());
  std::size_t entries = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    entries += entry.path().filename().string().rfind("saved", 0) == 0;
  EXPECT_EQ(entries, 0u);
  EXPECT_TRUE(semantic_octree::loadMap((folder / "tiles").string()) == plain.tree());
}

TEST_F(InFolder, isReadByMany) {
  map.folder()->save();
  CSemanticOctoMap one = empty(), other = empty();
  one.openFolder(tilesIn(folder / "tiles", true));
  other.openFolder(tilesIn(folder / "tiles", true));
  EXPECT_EQ(likelihoodsOf(one), likelihoodsOf(plain));
  EXPECT_EQ(likelihoodsOf(other), likelihoodsOf(plain));
  one.logger().logging_enable_console_output = false;
  EXPECT_FALSE(one.insertObservation(labeledPoints({{1, 2, 0}}, {1})));
  EXPECT_TRUE(contains(one.lastInsertion().refusal, "opened to be read"));
  one.saveMetricMapRepresentationToFile((folder / "read").string());
  EXPECT_TRUE(treeOf(one) == treeOf(plain));
}

TEST_F(InFolder, answersSeveralThreads) {
  const auto expected = likelihoodsOf(plain);
  const std::string drawing = drawingOf(plain);
  std::atomic<int> wrong = 0;
  const auto ask = [&] {
    for (int i = 0; i < 10; ++i) wrong += likelihoodsOf(map) != expected;
    wrong += drawingOf(map) != drawing;
    wrong += map.asString().empty() || map.isEmpty();
  };
  std::thread a(ask), b(ask), c(ask);
  a.join(), b.join(), c.join();
  EXPECT_EQ(wrong, 0);
}

TEST_F(InFolder, keepsTheAbstractionOfTheMapInMemory) {
  plain.setAbstraction(someAbstraction());
  map.setAbstraction(someAbstraction());
  plain.renderingOptions.compressed = map.renderingOptions.compressed = true;
  for (int i = 0; i < 2; ++i) {
    EXPECT_TRUE(bytesOf(*map.compress()) == bytesOf(*plain.compress()));
    EXPECT_TRUE(drawingOf(map) == drawingOf(plain));
    fill(plain);
    fill(map);
  }
  EXPECT_TRUE(bytesOf(CSemanticOctoMap(map)) == bytesOf(plain));
  EXPECT_TRUE(bytesOf(*CSemanticOctoMap(map).compress()) == bytesOf(*plain.compress()));
}

TEST_F(InFolder, isCopiedToMapsInMemory) {
  map.folder()->save();
  const std::string bytes = bytesOf(plain);
  CSemanticOctoMap copy(map), assigned, read;
  assigned = map;
  readBytes(read, bytesOf(map));
  mrpt::maps::CMultiMetricMap maps, copied;
  maps.maps.push_back(std::dynamic_pointer_cast<CSemanticOctoMap>(map.duplicateGetSmartPtr()));
  copied = maps;
  for (CSemanticOctoMap* each :
       {&copy, &assigned, &read, copied.mapByClass<CSemanticOctoMap>().get()}) {
    EXPECT_EQ(each->folder(), nullptr);
    EXPECT_TRUE(bytesOf(*each) == bytes);
    fill(*each);
    EXPECT_FALSE(bytesOf(*each) == bytes);
    each->clear();
  }
  EXPECT_TRUE(bytesOf(map) == bytes);
  map.folder()->save();
  EXPECT_TRUE(semantic_octree::loadMap((folder / "tiles").string()) == plain.tree());
}

TEST_F(InFolder, isNotCopiedWhereThereIsNoMemoryForIt) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers cannot do without memory";
#endif
  std::string ofCopy, ofArchive;
  {
    const NoMemoryLeft limit;
    ofCopy = errorOf([&] { CSemanticOctoMap copy(map); });
    ofArchive = errorOf([&] { bytesOf(map); });
  }
  EXPECT_TRUE(contains(ofCopy, "as a whole it needs about"));
  EXPECT_TRUE(contains(ofArchive, "as a whole it needs about"));
  EXPECT_TRUE(treeOf(map) == treeOf(plain));
}

TEST_F(InFolder, doesNotBecomeAnotherMap) {
  const std::string bytes = bytesOf(map);
  const CSemanticOctoMap other = empty();
  EXPECT_TRUE(contains(errorOf([&] { map = other; }), "cannot become another one"));
  EXPECT_TRUE(contains(errorOf([&] { readBytes(map, bytesOf(other)); }), "cannot become another"));
  EXPECT_TRUE(contains(errorOf([&] { map.openFolder(tilesIn(folder / "new")); }), "another one"));
  EXPECT_TRUE(contains(errorOf([&] { plain.openFolder(tilesIn(folder / "new")); }), "empty"));
  EXPECT_TRUE(bytesOf(map) == bytes);
  EXPECT_FALSE(std::filesystem::exists(folder / "new"));
}

TEST_F(InFolder, namesATileThatCannotBeRead) {
  map.folder()->save();
  CSemanticOctoMap damaged = empty();
  damaged.openFolder(tilesIn(folder / "tiles", true));
  damaged.setAbstraction(someAbstraction());
  for (const auto& entry : std::filesystem::directory_iterator(folder / "tiles"))
    if (entry.path().filename().string().rfind("tile_", 0) == 0)
      std::filesystem::resize_file(entry.path(), 50);
  EXPECT_TRUE(contains(errorOf([&] { likelihoodsOf(damaged); }), "tile_"));
  EXPECT_TRUE(contains(errorOf([&] { damaged.setAbstraction(someAbstraction()); }), "tile_"));
  EXPECT_FALSE(damaged.abstractionOptions().isSet());
}

TEST(MapInANewFolder, hasTheFilterThatItBeganWith) {
  const TemporaryFolder folder;
  CSemanticOctoMap map = empty();
  map.insertionOptions.filter.accuracy = 0.8;
  map.openFolder(tilesIn(folder / "tiles"));
  EXPECT_EQ(map.tree().filterParameters().accuracy, 0.8);
  map.insertionOptions.filter.accuracy = 0.7;
  map.logger().logging_enable_console_output = false;
  EXPECT_FALSE(map.insertObservation(labeledPoints({{1, 2, 0}}, {1})));
  EXPECT_TRUE(contains(map.lastInsertion().refusal, "filter parameters in insertionOptions"));
}

TEST(MapInANewFolder, isMadeOfAnIniFile) {
  const TemporaryFolder folder;
  const auto made = [&](const std::string& more, const std::string& resolution = "0.2") {
    mrpt::maps::TSetOfMetricMapInitializers definitions;
    definitions.loadFromConfigFile(
        mrpt::config::CConfigFileMemory(
            "[M]\nsemanticOctoMap_count = 1\n[M_semanticOctoMap_00_creationOpts]\nresolution = " +
            resolution + "\n[M_semanticOctoMap_00_folderOpts]\nfolder = " +
            (folder / "tiles").string() + "\n" + more),
        "M");
    return mrpt::maps::CMultiMetricMap(definitions).mapByClass<CSemanticOctoMap>();
  };
  {
    const auto map = made("memory = 3\ntile_size = 6.4\n");
    ASSERT_TRUE(map->folder());
    map->insertObservation(labeledPoints({{3, 1, 0}, {-4, 2, 1}}, {1, 1}));
    map->saveMetricMapRepresentationToFile("unused");
  }
  const auto map = made("read_only = true\n");
  EXPECT_FALSE(map->isEmpty());
  EXPECT_EQ(map->folder()->contents().tileSize, 6.4);
  EXPECT_TRUE(contains(errorOf([&] { made("", "0.3"); }), "another resolution"));
  EXPECT_TRUE(contains(errorOf([&] { made("memory = -1\n"); }), "memory"));
  EXPECT_TRUE(contains(errorOf([&] { made("read_only = perhaps\n"); }), "read_only"));
}
