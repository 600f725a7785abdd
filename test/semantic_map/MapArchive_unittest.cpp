#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/maps/CMultiMetricMap.h>

#include "ArchiveStream.h"
#include "SmallMaps.h"
#include "TemporaryFolder.h"

using semantic_map::CSemanticOctoMap;
using semantic_map::TRenderingOptions;

namespace {

/** A map with contents, and no option at its default. */
CSemanticOctoMap unusualMap() {
  semantic_octree::FilterParameters filter;
  filter.accuracy = 0.7, filter.hitProbability = 0.65, filter.falseAlarmProbability = 0.15;
  filter.minOccupancy = 0.2, filter.maxProbability = 0.9, filter.softLabelFloor = 0.01;
  CSemanticOctoMap map(0.3, threeClasses(), filter);
  map.genericMapParams.enableSaveAs3DObject = false;
  map.insertionOptions.scan.rays = semantic_octree::InsertionOptions::Rays::EndVoxels;
  map.insertionOptions.scan.maxRange = 7;
  map.insertionOptions.scan.threads = 2;
  map.insertionOptions.maxGap = 33;
  map.insertionOptions.conversion.decimation = 3;
  map.insertionOptions.conversion.labels.minConfidence = 0.3;
  map.likelihoodOptions.decimation = 4;
  map.likelihoodOptions.useLabels = false;
  map.renderingOptions.coloring = TRenderingOptions::Coloring::Entropy;
  map.renderingOptions.minHeight = -3;
  map.renderingOptions.compressed = true;
  map.likelihoodOptions.beamStep = 0.7;
  map.likelihoodOptions.pointWeight = 0.4;
  fill(map);
  return map;
}

template <class Value>
void append(std::string& bytes, const Value& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/** The bytes of what a map answers: states of places, likelihoods, matches, its scene, its
 * compressed form, and what another scan makes of it. */
std::string answersOf(CSemanticOctoMap& map) {
  std::string bytes;
  for (double x = -6; x < 6; x += 0.37)
    for (double y = -6; y < 6; y += 0.41) {
      const auto state = map.tree().query(x, y, 0.1);
      append(bytes, state.occupancy), append(bytes, state.probability);
      append(bytes, state.likeliestClass);
      append(bytes, map.squareDistanceToClosestCorrespondence(float(x), float(y)));
    }
  const auto scan = labeledPoints({{4, 1, 0}, {-2, 3, 0.5f}, {0, -4, 1}, {1, 1, 1}}, {1, 2, 3, 0});
  for (double x = -1; x < 1; x += 0.11)
    append(bytes, map.computeObservationLikelihood(scan, mrpt::poses::CPose3D(x, 0, 0, x, 0, 0)));
  bytes += bytesOf(*map.getVisualization()) + bytesOf(*map.compress()) + map.asString();
  fill(map);
  return bytes + bytesOf(map);
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
  EXPECT_EQ(read.insertionOptions.conversion.labels.minConfidence, 0.3);
  EXPECT_FALSE(read.genericMapParams.enableSaveAs3DObject);
  EXPECT_EQ(read.renderingOptions.coloring, TRenderingOptions::Coloring::Entropy);
  EXPECT_EQ(read.likelihoodOptions.decimation, 4);
  EXPECT_TRUE(read.insertionOptions.filter == map.tree().filterParameters());
}

TEST(MapArchive, optionsThatAreNoneAnyMoreAreLeftOut) {
  std::string bytes = bytesOf(unusualMap());
  bytes.replace(bytes.find("point_weight"), 5, "plane");
  CSemanticOctoMap read;
  readBytes(read, bytes);
  EXPECT_TRUE(read.tree() == unusualMap().tree());
  EXPECT_EQ(read.likelihoodOptions.decimation, 4);
  EXPECT_EQ(read.likelihoodOptions.pointWeight, 1);
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

TEST(MapArchive, thoseOfAnotherVersionAreRefused) {
  std::string bytes = bytesOf(unusualMap());
  const std::string name = "CSemanticOctoMap";
  const std::size_t version = bytes.find(name) + name.size();
  ASSERT_EQ(bytes.at(version), 2);
  CSemanticOctoMap map(0.2, threeClasses());
  for (const char other : {1, 3}) {
    bytes[version] = other;
    EXPECT_ANY_THROW(readBytes(map, bytes));
  }
}

TEST(MapArchive, everyWayOfCopyingAnswersEveryQueryAlike) {
  const TemporaryFolder folder;
  CSemanticOctoMap map = unusualMap();
  map.genericMapParams.enableSaveAs3DObject = true;
  map.setAbstraction(someAbstraction());
  const std::string file = (folder / "map.gz").string();
  {
    mrpt::io::CFileGZOutputStream out(file);
    mrpt::serialization::archiveFrom(out) << map;
  }
  CSemanticOctoMap fromFile, fromArchive;
  mrpt::io::CFileGZInputStream in(file);
  mrpt::serialization::archiveFrom(in).ReadObject(&fromFile);
  readBytes(fromArchive, bytesOf(map));
  mrpt::maps::CMultiMetricMap maps, copied;
  maps.maps.push_back(std::make_shared<CSemanticOctoMap>(map));
  copied = maps;
  const auto duplicate = std::dynamic_pointer_cast<CSemanticOctoMap>(map.duplicateGetSmartPtr());
  const std::string expected = answersOf(map);
  EXPECT_TRUE(answersOf(fromFile) == expected);
  EXPECT_TRUE(answersOf(fromArchive) == expected);
  EXPECT_TRUE(answersOf(*copied.mapByClass<CSemanticOctoMap>()) == expected);
  EXPECT_TRUE(answersOf(*duplicate) == expected);
}

TEST(MapArchive, aTextIsNoLongerThanTheArchive) {
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  archive << std::uint32_t{4000000000} << std::uint32_t{0};
  memory.Seek(0);
  EXPECT_THROW(semantic_map::readText(archive), std::exception);
}
