// Files that are to be new do not replace what others put there meanwhile.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <strict_files/OutputFiles.h>
#include <strict_files/TextFile.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>

#include "TemporaryFolder.h"

namespace fs = std::filesystem;
using strict_files::declareNew;
using strict_files::OutputFolder;
using strict_files::StagedFile;

namespace {

/** What a file system is able to do. */
enum class Renaming { WithoutReplacing, ByLinks, Neither };
Renaming renaming = Renaming::WithoutReplacing;

/** The only entry that begins with "kept-". */
fs::path keptIn(const fs::path& folder) {
  fs::path kept;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().filename().string().rfind("kept-", 0) == 0) {
      EXPECT_TRUE(kept.empty());
      kept = entry.path();
    }
  return kept;
}

class NewFiles : public testing::TestWithParam<Renaming> {
 protected:
  void SetUp() override { renaming = GetParam(); }
  void TearDown() override { renaming = Renaming::WithoutReplacing; }
  const TemporaryFolder folder;
};

}  // namespace

// The library calls these two of ours.
extern "C" int renameat2(int oldFolder, const char* from, int newFolder, const char* to,
                         unsigned flags) noexcept {
  if (renaming == Renaming::WithoutReplacing)
    return static_cast<int>(syscall(SYS_renameat2, oldFolder, from, newFolder, to, flags));
  errno = EINVAL;
  return -1;
}
extern "C" int link(const char* from, const char* to) noexcept {
  if (renaming != Renaming::Neither)
    return static_cast<int>(syscall(SYS_linkat, AT_FDCWD, from, AT_FDCWD, to, 0));
  errno = EPERM;
  return -1;
}

INSTANTIATE_TEST_SUITE_P(OnAnyFileSystem, NewFiles,
                         testing::Values(Renaming::WithoutReplacing, Renaming::ByLinks,
                                         Renaming::Neither));

TEST_P(NewFiles, takeTheirPlaceWhereNothingIs) {
  declareNew(folder / "a");
  strict_files::writeText(folder / "a", "first");
  EXPECT_EQ(folder.read("a"), "first");
  strict_files::writeText(folder / "a", "second");  // its own
  EXPECT_EQ(folder.read("a"), "second");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST_P(NewFiles, areKeptUnderAnotherNameWhereSomebodyElseWasFaster) {
  declareNew(folder / "./a.txt");
  StagedFile file(folder / "a.txt");
  folder.write("a.txt", "theirs");
  std::ofstream(file.path()) << "ours";
  const std::string error = errorOf([&] { file.commit(); });
  EXPECT_EQ(folder.read("a.txt"), "theirs");
  const fs::path kept = keptIn(folder.path());
  EXPECT_EQ(kept.extension(), ".txt");
  EXPECT_EQ(strict_files::readText(kept), "ours");
  EXPECT_EQ(error, (folder / "a.txt").string() +
                       ": cannot be written: somebody else has written it since this program "
                       "began; what belongs there is now " +
                       kept.string());
}

TEST_P(NewFiles, ofAFolderAreKeptTogether) {
  for (const char* name : {"out/a", "out/b", "out/c"}) declareNew(folder / name);
  {
    OutputFolder output(folder / "out");
    for (const char* name : {"a", "b"}) std::ofstream(output.staged(name)) << "ours";
    folder.write("out/b", "theirs");
    folder.write("out/c", "theirs");
    const std::string error = errorOf([&] { output.commit({"a", "b", "c"}); });
    EXPECT_TRUE(contains(error, (folder / "out/b").string() + ": cannot be written"));
  }
  const fs::path kept = keptIn(folder / "out");
  for (const char* name : {"a", "b"}) EXPECT_EQ(strict_files::readText(kept / name), "ours");
  EXPECT_FALSE(fs::exists(folder / "out/a"));
  EXPECT_EQ(folder.read("out/b"), "theirs");
  EXPECT_EQ(folder.read("out/c"), "theirs");
}

TEST_P(NewFiles, thatWereNotWrittenDoNotRemoveWhatSomebodyElseWrote) {
  declareNew(folder / "out/a");
  OutputFolder output(folder / "out");
  folder.write("out/a", "theirs");
  output.commit({"a"});
  EXPECT_EQ(folder.read("out/a"), "theirs");
}
