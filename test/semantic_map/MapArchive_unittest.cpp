#include <gtest/gtest.h>
#include <mrpt/maps/CMultiMetricMap.h>

#include "SmallMaps.h"

using semantic_map::CSemanticOctoMap;
using semantic_map::TRenderingOptions;

namespace {

/** A map with contents, and no option at its default. */
CSemanticOctoMap unusualMap() {
  semantic_octree::FilterParameters filter;
  filter.accuracy = 0.7, filter.hitProbability = 0.65, filter.falseAlarmProbability = 0.15;
  CSemanticOctoMap map(0.3, threeClasses(), filter);
  map.genericMapParams.enableSaveAs3DObject = false;
  map.insertionOptions.scan.rays = semantic_octree::InsertionOptions::Rays::EndVoxels;
  map.insertionOptions.scan.maxRange = 7;
  map.insertionOptions.scan.threads = 2;
  map.insertionOptions.conversion.decimation = 3;
  map.likelihoodOptions.decimation = 4;
  map.likelihoodOptions.useLabels = false;
  map.renderingOptions.coloring = TRenderingOptions::Coloring::Height;
  map.renderingOptions.minHeight = -3;
  fill(map);
  return map;
}

}  // namespace

TEST(MapArchive, whatIsReadBackEqualsBitForBit) {
  const CSemanticOctoMap map = unusualMap();
  const std::string bytes = bytesOf(map);
  CSemanticOctoMap read;
  readBytes(read, bytes);
  EXPECT_TRUE(bytesOf(read) == bytes);
  EXPECT_EQ(read.tree().getResolution(), 0.3);
  EXPECT_TRUE(read.tree().classes() == map.tree().classes());
  EXPECT_EQ(read.insertionOptions.scan.maxRange, 7);
  EXPECT_FALSE(read.genericMapParams.enableSaveAs3DObject);
  EXPECT_EQ(read.renderingOptions.coloring, TRenderingOptions::Coloring::Height);
  EXPECT_EQ(read.likelihoodOptions.decimation, 4);
}

TEST(MapArchive, anArchiveKnowsTheClassByName) {
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << unusualMap() << std::string("behind");
  stream.Seek(0);
  const auto object = archive.ReadObject();
  ASSERT_TRUE(std::dynamic_pointer_cast<CSemanticOctoMap>(object));
  std::string behind;
  archive >> behind;
  EXPECT_EQ(behind, "behind");
}

TEST(MapArchive, anEmptyMapIsReadBackToo) {
  CSemanticOctoMap read = unusualMap();
  readBytes(read, bytesOf(CSemanticOctoMap(0.5, threeClasses())));
  EXPECT_TRUE(read.isEmpty());
  EXPECT_EQ(read.tree().getResolution(), 0.5);
}

TEST(MapArchive, aTruncatedArchiveIsAnErrorAndLeavesTheMap) {
  const std::string whole = bytesOf(CSemanticOctoMap(0.5, threeClasses()));
  const std::string large = bytesOf(unusualMap());
  CSemanticOctoMap map(0.2, threeClasses());
  fill(map);
  const std::string before = bytesOf(map);
  // The last byte is MRPT's end mark, which it looks for when the object is complete.
  for (std::size_t length = 0; length + 1 < whole.size(); ++length)
    EXPECT_ANY_THROW(readBytes(map, whole.substr(0, length))) << length;
  for (std::size_t length = 1; length + 1 < large.size(); length += 97)
    EXPECT_ANY_THROW(readBytes(map, large.substr(0, length))) << length;
  EXPECT_TRUE(bytesOf(map) == before);
}

TEST(MapArchive, anAlteredTreeIsAnErrorAndLeavesTheMap) {
  std::string bytes = bytesOf(unusualMap());
  CSemanticOctoMap map(0.2, threeClasses());
  const std::string before = bytesOf(map);
  bytes[bytes.size() - 100] = static_cast<char>(bytes[bytes.size() - 100] ^ 4);
  EXPECT_ANY_THROW(readBytes(map, bytes));
  EXPECT_TRUE(bytesOf(map) == before);
}

TEST(MapArchive, copiesOfEveryKindEqualBitForBitAndAreIndependent) {
  const CSemanticOctoMap map = unusualMap();
  const std::string bytes = bytesOf(map);
  CSemanticOctoMap copy(map), assigned;
  assigned = map;
  const auto duplicate = map.duplicateGetSmartPtr();
  EXPECT_TRUE(bytesOf(copy) == bytes);
  EXPECT_TRUE(bytesOf(assigned) == bytes);
  EXPECT_TRUE(bytesOf(dynamic_cast<CSemanticOctoMap&>(*duplicate)) == bytes);
  fill(copy);
  assigned.clear();
  EXPECT_FALSE(bytesOf(copy) == bytes);
  EXPECT_TRUE(bytesOf(map) == bytes);
}

TEST(MapArchive, multiMetricMapsCopyWithoutLoss) {
  mrpt::maps::CMultiMetricMap maps, copy;
  maps.maps.push_back(std::make_shared<CSemanticOctoMap>(unusualMap()));
  copy = maps;
  const auto inside = copy.mapByClass<CSemanticOctoMap>();
  ASSERT_TRUE(inside);
  EXPECT_NE(inside.get(), maps.maps[0].get());
  EXPECT_TRUE(bytesOf(*inside) == bytesOf(unusualMap()));
}
