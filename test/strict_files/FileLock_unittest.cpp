#include <gtest/gtest.h>
#include <strict_files/OutputFiles.h>

#include "TemporaryFolder.h"

using strict_files::FileLock;
using Kind = FileLock::Kind;

TEST(FileLock, isHeldByManyReadersOrOneWriter) {
  const TemporaryFolder folder;
  const auto file = folder / "lock";
  {
    const FileLock one(file, Kind::Shared), another(file, Kind::Shared);
    EXPECT_TRUE(FileLock::tryTo(file, Kind::Shared));
    EXPECT_FALSE(FileLock::tryTo(file, Kind::Exclusive));
  }
  auto writer = FileLock::tryTo(file, Kind::Exclusive);
  EXPECT_TRUE(writer);
  EXPECT_FALSE(FileLock::tryTo(file, Kind::Shared));
  const FileLock moved = std::move(*writer);
  writer.reset();
  EXPECT_FALSE(FileLock::tryTo(file, Kind::Exclusive));
}

TEST(FileLock, isEverybodysWhereItCannotBeMade) {
  const TemporaryFolder folder;
  EXPECT_TRUE(FileLock::tryTo(folder / "nowhere/lock", Kind::Exclusive));
  EXPECT_TRUE(FileLock::tryTo(folder / "nowhere/lock", Kind::Exclusive));
}

TEST(StagedFile, mayComeToTheDiskLater) {
  const TemporaryFolder folder;
  strict_files::StagedFile file(folder / "later.txt");
  std::ofstream(file.path()) << "content";
  file.commit(strict_files::StagedFile::Disk::Later);
  EXPECT_EQ(folder.read("later.txt"), "content");
}
