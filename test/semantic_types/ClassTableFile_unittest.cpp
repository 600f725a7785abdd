#include <gtest/gtest.h>
#include <semantic_types/ClassTable.h>

#include <set>

#include "SharedData.h"
#include "TemporaryFolder.h"

using semantic_types::ClassTable;
using semantic_types::Color;
using semantic_types::kNoClass;
using semantic_types::loadClassTable;

namespace {

ClassTable shipped(const std::string& name) {
  return loadClassTable(std::filesystem::path(MSO_SOURCE_DIR) / "config/classes" / name);
}

std::string errorFor(const std::string& text) {
  const TemporaryFolder folder;
  const auto file = folder.write("table.yaml", text);
  const std::string error = errorOf([&] { loadClassTable(file); });
  EXPECT_EQ(error.rfind(file.string(), 0), 0u) << "does not begin with the file: " << error;
  return error.substr(std::min(error.size(), file.string().size()));
}

int numberOfColors(const ClassTable& table) {
  std::set<std::array<int, 3>> colors;
  for (int id = 1; id <= table.size(); ++id) {
    const Color c = table.color(id);
    colors.insert({c.r, c.g, c.b});
  }
  return static_cast<int>(colors.size());
}

}  // namespace

TEST(ClassTableFile, readsClassesInAnyOrderFoldsAndPolicy) {
  const TemporaryFolder folder;
  const ClassTable table = loadClassTable(folder.write("t.yaml", R"(
unknown_raw_id: no_class
no_class: [0, 99]
classes:
  - {id: 2, name: "it's: grass", color: [0, 255, 1]}
  - id: 1
    name: road
    color: [128, 64, 128]
    raw: [40, 60]
)"));
  ASSERT_EQ(table.size(), 2);
  EXPECT_EQ(table.name(1), "road");
  EXPECT_EQ(table.name(2), "it's: grass");
  EXPECT_TRUE((table.color(2) == Color{0, 255, 1}));
  EXPECT_EQ(table.fromRaw(60), 1);
  EXPECT_EQ(table.fromRaw(99), kNoClass);
  EXPECT_EQ(table.fromRaw(1234), kNoClass);
}

TEST(ClassTableFile, readsHalfLivesAndWithoutThemNothingIsForgotten) {
  const TemporaryFolder folder;
  const ClassTable table = loadClassTable(folder.write("t.yaml", R"(
free_half_life: 3600
classes:
  - {id: 1, name: road, color: [128, 64, 128]}
  - {id: 2, name: person, color: [220, 20, 60], half_life: 2.5}
)"));
  EXPECT_EQ(table.halfLife(kNoClass), 3600);
  EXPECT_EQ(table.halfLife(1), semantic_types::kForever);
  EXPECT_EQ(table.halfLife(2), 2.5);
  EXPECT_TRUE(table.hasHalfLives());
  EXPECT_FALSE(shipped("synthetic.yaml").hasHalfLives());
  EXPECT_THROW(table.halfLife(3), std::out_of_range);
}

TEST(ClassTableFile, theExampleOfHalfLivesHasTheClassesOfTheSyntheticWorlds) {
  const ClassTable worlds = shipped("synthetic.yaml");
  ClassTable example = shipped("synthetic_decay.yaml");
  EXPECT_EQ(example.halfLife(*example.find("person")), 2);
  EXPECT_FALSE(example == worlds);
  for (int id = 1; id <= example.size(); ++id)
    example.setHalfLife(static_cast<semantic_types::ClassId>(id), semantic_types::kForever);
  EXPECT_TRUE(example == worlds);
}

TEST(ClassTableFile, errorsNameFileLineAndValue) {
  const std::string one = "classes:\n  - {id: 1, name: a, color: [1, 2, 3]}\n";
  EXPECT_EQ(errorFor(""), ": expected 'key: value' entries");
  EXPECT_EQ(errorFor("no_class: [0]\n"), ":1: key 'classes' is missing");
  EXPECT_EQ(errorFor("classes: []\n"), ":1: classes: expected a list of 1 to 254 classes");
  EXPECT_EQ(
      errorFor(one + "colour: 1\n"),
      ":3: unknown key 'colour'; known are classes, free_half_life, no_class, unknown_raw_id");
  EXPECT_EQ(errorFor("best_to_worst: [a]\n"),
            ":1: this is an order of classes; expected the keys classes, free_half_life, no_class, "
            "unknown_raw_id");
  EXPECT_EQ(errorFor(one + "no_class: [0]\nno_class: [1]\n"), ":4: key 'no_class' twice");
  EXPECT_EQ(errorFor(one + "no_class: [-1]\n"), ":3: expected a raw id, found '-1'");
  EXPECT_EQ(errorFor(one + "no_class: 7\n"), ":3: expected a list of raw ids");
  EXPECT_EQ(errorFor(one + "no_class: [5, 5]\n"), ":3: class table: raw id 5 folds twice");
  EXPECT_EQ(errorFor(one + "unknown_raw_id: maybe\n"),
            ":3: unknown_raw_id: expected error or no_class, found 'maybe'");
  EXPECT_EQ(errorFor(one + "  - {id: 3, name: b, color: [1, 2, 3]}\n"),
            ":3: class id 3: the ids of 2 classes must be 1..2 without gaps");
  EXPECT_EQ(errorFor(one + "  - {id: 1, name: b, color: [1, 2, 3]}\n"), ":3: class id 1 twice");
  EXPECT_EQ(errorFor(one + "  - {id: 2, name: a, color: [1, 2, 3]}\n"),
            ":3: class table: two classes named 'a'");
  EXPECT_EQ(errorFor(one + "  - {id: 2, color: [1, 2, 3]}\n"), ":3: key 'name' is missing");
  EXPECT_EQ(errorFor(one + "  - {id: 2, name: b}\n"), ":3: key 'color' is missing");
  EXPECT_EQ(errorFor(one + "  - {id: 2, name: b, color: [1, 2, 256]}\n"),
            ":3: expected color: [r, g, b], each 0..255, found 256");
  EXPECT_EQ(errorFor(one + "  - {id: two, name: b, color: [1, 2, 3]}\n"),
            ":3: expected a class id, found 'two'");
  EXPECT_EQ(errorFor(one + "  - {id: 2, name: b, color: [1, 2, 3], alpha: 1}\n"),
            ":3: unknown key 'alpha'; known are color, half_life, id, name, raw");
  EXPECT_EQ(errorFor(one + "  - {id: 2, name: b, color: [1, 2, 3], half_life: 0}\n"),
            ":3: class table: half-life of 'b' = 0 s, expected 0.001 to 1000000000");
  EXPECT_EQ(errorFor(one + "free_half_life: 1e10\n"),
            ":3: class table: half-life of free space = 10000000000 s, expected 0.001 to "
            "1000000000");
}

TEST(ClassTableFile, aSyntaxErrorOrATruncatedFileIsAnErrorAndNoShorterTable) {
  EXPECT_TRUE(
      contains(errorFor("classes:\n  - {id: 1, name: a, color: [1, 2, 3]}\n  - {id: 2, na"), ":"));
  EXPECT_NE(errorFor("classes:\n  - id: 1\n   name: a\n"), "");
}

TEST(ClassTableFile, aMissingFileIsNamed) {
  EXPECT_EQ(errorOf([] { loadClassTable("/nowhere/t.yaml"); }), "/nowhere/t.yaml: cannot be read");
}

TEST(ShippedClassTables, rugdHas24ClassesWithItsColors) {
  const ClassTable rugd = shipped("rugd.yaml");
  EXPECT_EQ(rugd.size(), 24);
  EXPECT_EQ(numberOfColors(rugd), 24);
  EXPECT_EQ(rugd.find(Color{0, 102, 0}), rugd.find("grass"));
  EXPECT_EQ(rugd.fromRaw(24), rugd.find("picnic-table"));
  EXPECT_EQ(rugd.fromRaw(0), kNoClass);
  EXPECT_THROW(rugd.fromRaw(25), std::invalid_argument);
}

TEST(ShippedClassTables, ofTheSyntheticWorldsInRugdIsRugdsWithOtherRawIds) {
  const ClassTable rugd = shipped("rugd.yaml"), folded = shipped("synthetic_as_rugd.yaml");
  ASSERT_EQ(folded.size(), rugd.size());
  for (semantic_types::ClassId id = 1; id <= rugd.size(); ++id) {
    EXPECT_EQ(folded.name(id), rugd.name(id));
    EXPECT_EQ(folded.color(id), rugd.color(id));
  }
  EXPECT_EQ(folded.folds().size(), static_cast<std::size_t>(shipped("synthetic.yaml").size()));
}

TEST(ShippedClassTables, semanticKittiFoldsTo19ClassesMovingOnesIncluded) {
  const ClassTable kitti = shipped("semantic_kitti.yaml");
  EXPECT_EQ(kitti.size(), 19);
  EXPECT_EQ(numberOfColors(kitti), 19);
  EXPECT_EQ(kitti.name(9), "road");
  for (const auto raw : {0, 1, 52, 99}) EXPECT_EQ(kitti.fromRaw(raw), kNoClass);
  EXPECT_EQ(kitti.fromRaw(252), kitti.find("car"));
  EXPECT_EQ(kitti.fromRaw(60), kitti.find("road"));
  EXPECT_THROW(kitti.fromRaw(200), std::invalid_argument);
}

TEST(ShippedClassTables, semanticKittiAgreesWithTheDataSetsOwnList) {
  SKIP_WITHOUT_DATA("semantic_kitti");
  const ClassTable kitti = shipped("semantic_kitti.yaml");
  std::ifstream list(sharedDataDir() / "semantic_kitti/classes.txt");
  int raw, r, g, b, fold, seen = 0;
  std::string name;
  list.ignore(1000, '\n');
  for (; list >> raw >> name >> r >> g >> b >> fold; ++seen)
    EXPECT_EQ(kitti.fromRaw(raw), fold) << raw;
  EXPECT_EQ(seen, 34);
}

TEST(ShippedClassTables, replicaHas101ClassesThatAPersonCanTellApart) {
  const ClassTable replica = shipped("replica_apartment.yaml");
  EXPECT_EQ(replica.size(), 101);
  EXPECT_EQ(numberOfColors(replica), 101);
  EXPECT_EQ(replica.fromRaw(0), kNoClass);
  SKIP_WITHOUT_DATA("replica_apartment_0");
  std::ifstream list(sharedDataDir() / "replica_apartment_0/classes.txt");
  int id, seen = 0;
  std::string name;
  list.ignore(1000, '\n');
  for (; list >> id >> name; ++seen) EXPECT_EQ(replica.name(id), name);
  EXPECT_EQ(seen, 101);
}
