#include <gtest/gtest.h>
#include <semantic_types/ClassTable.h>

#include "Classes.h"
#include "TemporaryFolder.h"

using namespace semantic_types;

namespace {

ClassTable table() {
  return tableOf({{"road", {90, 90, 90}}, {"snow", {255, 255, 255}}, {"coal", {0, 0, 0}}});
}

}  // namespace

TEST(ClassTable, numbersClassesFromOne) {
  const ClassTable classes = table();
  EXPECT_EQ(classes.size(), 3);
  EXPECT_EQ(classes.name(1), "road");
  EXPECT_EQ(classes.find("coal"), ClassId{3});
  EXPECT_EQ(classes.find("mud"), std::nullopt);
  EXPECT_FALSE(classes.contains(0));
  EXPECT_FALSE(classes.contains(4));
}

TEST(ClassTable, namesWhatHasNoClassAndRefusesIdsAboveItsSize) {
  const ClassTable classes = table();
  EXPECT_EQ(classes.name(kNoClass), "no class");
  EXPECT_NO_THROW(classes.color(kNoClass));
  EXPECT_EQ(classes.find("no class"), std::nullopt);
  EXPECT_THROW(classes.name(4), std::out_of_range);
  EXPECT_THROW(classes.color(4), std::out_of_range);
  EXPECT_EQ(ClassTable().name(kNoClass), "no class");
  EXPECT_THROW(ClassTable().name(1), std::out_of_range);
}

TEST(ClassTable, takesRawIdsForItsOwnOnlyWhereNoneFoldsToAClass) {
  ClassTable classes = table();
  classes.fold(0, kNoClass);
  EXPECT_EQ(classes.fromRaw(3), 3);
  classes.fold(40, 1);
  EXPECT_TRUE(contains(errorOf([&] { classes.fromRaw(3); }), "3"));
}

TEST(ClassTable, treatsUnknownRawIdsAsTold) {
  ClassTable classes = table();
  EXPECT_TRUE(contains(errorOf([&] { classes.fromRaw(70000); }), "70000"));
  EXPECT_TRUE(contains(errorOf([&] { classes.fromRaw(0); }), "0"));
  classes.setUnknownRawId(ClassTable::UnknownRawId::NoClass);
  EXPECT_EQ(classes.fromRaw(70000), kNoClass);
}

TEST(ClassTable, refusesWhatIsAmbiguous) {
  ClassTable classes = table();
  EXPECT_THROW(classes.add("road", {}), std::invalid_argument);
  EXPECT_THROW(classes.add("", {}), std::invalid_argument);
  EXPECT_THROW(classes.fold(9, 4), std::invalid_argument);
  classes.fold(9, 2);
  EXPECT_THROW(classes.fold(9, 2), std::invalid_argument);
  EXPECT_EQ(classes.size(), 3);
}

TEST(ClassTable, refusesNamesWithControlCharactersOrBytesThatAreNoUtf8AndShowsThem) {
  ClassTable classes = table();
  EXPECT_EQ(errorOf([&] { classes.add("road\n!touch x\n", {}); }),
            "class table: the name of class 4, 'road\\x0a!touch x\\x0a', has control characters or "
            "is not UTF-8");
  for (const char* name : {"\x1b[2J", "a\tb", "\x7f", "\xC2\x85",
                           "stra\xDF"
                           "e"})
    EXPECT_THROW(classes.add(name, {}), std::invalid_argument) << name;
  EXPECT_EQ(classes.size(), 3);
}

TEST(ClassTable, holdsUpTo254Classes) {
  ClassTable classes;
  for (int i = 1; i <= 254; ++i) EXPECT_EQ(classes.add("class " + std::to_string(i), {}), i);
  EXPECT_THROW(classes.add("one more", {}), std::invalid_argument);
  EXPECT_EQ(classes.size(), 254);
}

TEST(ClassTable, differsInEachPart) {
  const ClassTable classes = table();
  EXPECT_EQ(classes, table());
  ClassTable other = table();
  other.fold(5, 1);
  EXPECT_NE(classes, other);
  other = table();
  other.setUnknownRawId(ClassTable::UnknownRawId::NoClass);
  EXPECT_NE(classes, other);
  other = table();
  other.add("more", {});
  EXPECT_NE(classes, other);
}
