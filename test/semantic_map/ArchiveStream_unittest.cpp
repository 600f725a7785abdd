#include "ArchiveStream.h"

#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>

#include <istream>
#include <ostream>

using semantic_map::ArchiveStreambuf;

TEST(ArchiveStream, wordsAndCharactersMixAndNotAByteMoreIsTaken) {
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  {
    ArchiveStreambuf buffer(archive);
    std::ostream out(&buffer);
    out.put('a');
    out.write("bcdef", 5);
    archive << std::string("behind");
  }
  memory.Seek(0);
  ArchiveStreambuf buffer(archive);
  std::istream in(&buffer);
  EXPECT_EQ(in.peek(), 'a');
  char text[5] = {};
  in.read(text, 4);
  EXPECT_EQ(std::string(text), "abcd");
  EXPECT_EQ(in.get(), 'e');
  EXPECT_EQ(in.get(), 'f');
  std::string behind;
  archive >> behind;
  EXPECT_EQ(behind, "behind");
}

TEST(ArchiveStream, theEndOfTheArchiveIsABadStream) {
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  ArchiveStreambuf buffer(archive);
  std::istream in(&buffer);
  char byte;
  EXPECT_FALSE(in.read(&byte, 1));
}

TEST(ArchiveStream, textsAreReadAsMrptWritesThem) {
  const std::string full(10000, 'x');
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  archive << std::string("name") << std::string() << full;
  memory.Seek(0);
  EXPECT_EQ(semantic_map::readText(archive), "name");
  EXPECT_EQ(semantic_map::readText(archive), "");
  EXPECT_EQ(semantic_map::readText(archive), full);
}

TEST(ArchiveStream, aTextIsNoLongerThanTheArchive) {
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  archive << std::uint32_t{4000000000} << std::uint32_t{0};
  memory.Seek(0);
  EXPECT_THROW(semantic_map::readText(archive), std::exception);
}
