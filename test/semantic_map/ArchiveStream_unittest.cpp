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
