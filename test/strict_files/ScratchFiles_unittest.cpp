#include <gtest/gtest.h>
#include <strict_files/OutputFiles.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <utility>

#include "TemporaryFolder.h"

namespace {

namespace fs = std::filesystem;
using strict_files::FileLock;
using strict_files::ScratchFile;
using FileLocks = FolderTest;
using ScratchFiles = FolderTest;
using Kind = FileLock::Kind;

std::string readAt(const ScratchFile& file, std::uint64_t place, std::size_t size) {
  std::string bytes(size, '\0');
  file.read(place, bytes.data(), size);
  return bytes;
}

}  // namespace

TEST_F(ScratchFiles, givesBackWhatWasWrittenAndLeavesNothingBehind) {
  {
    ScratchFile file(folder.path());
    const std::string first(100000, 'a'), second(300, 'b');
    const auto a = file.append(first.data(), first.size());
    const auto b = file.append(second.data(), second.size());
    EXPECT_EQ(readAt(file, a, first.size()), first);
    file.discard(a, first.size());
    EXPECT_EQ(readAt(file, b, second.size()), second);
    const auto c = file.append(first.data(), 10);
    EXPECT_EQ(readAt(file, b, 310), second + first.substr(0, 10));
    EXPECT_EQ(c, first.size() + second.size());
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST_F(ScratchFiles, givesBackToTheDiskWhatIsDiscarded) {
  ScratchFile file(folder.path());
  const std::string much(1 << 20, 'a');
  const auto a = file.append(much.data(), much.size());
  const auto bytesOnDisk = [&] {
    struct stat status;
    EXPECT_EQ(stat(fs::directory_iterator(folder.path())->path().c_str(), &status), 0);
    return 512 * static_cast<std::size_t>(status.st_blocks);
  };
  if (bytesOnDisk() < much.size())
    GTEST_SKIP() << "a file system that stores less than it is given";
  file.discard(a, much.size());
  EXPECT_LT(bytesOnDisk(), much.size() / 2);
}

TEST_F(ScratchFiles, saysWhereItCannotBe) {
  EXPECT_TRUE(contains(errorOf([&] { ScratchFile(folder / "absent"); }), folder / "absent"));
}

TEST_F(ScratchFiles, doesNotReadBeyondItsEnd) {
  ScratchFile file(folder.path());
  file.append("abc", 3);
  char bytes[10];
  EXPECT_THROW(file.read(0, bytes, 10), std::runtime_error);
}

TEST_F(FileLocks, isHeldByManyReadersOrOneWriter) {
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

TEST_F(FileLocks, isEverybodysWhereItCannotBeMade) {
  EXPECT_TRUE(FileLock::tryTo(folder / "nowhere/lock", Kind::Exclusive));
  EXPECT_TRUE(FileLock::tryTo(folder / "nowhere/lock", Kind::Exclusive));
}
