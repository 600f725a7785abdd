#include <gtest/gtest.h>
#include <strict_files/OutputFolder.h>
#include <strict_files/StagedFile.h>

#include <fstream>

#include "TemporaryFolder.h"

namespace fs = std::filesystem;
using strict_files::OutputFolder;
using strict_files::StagedFile;

namespace {

void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

std::size_t entriesOf(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

TEST(StagedFile, takesItsNameWhenItIsComplete) {
  const TemporaryFolder folder;
  folder.write("a", "before");
  StagedFile file(folder / "a");
  write(file.path(), "after");
  EXPECT_EQ(folder.read("a"), "before");
  file.commit();
  EXPECT_EQ(folder.read("a"), "after");
  EXPECT_EQ(entriesOf(folder.path()), 1u);
}

TEST(StagedFile, withoutCommitLeavesWhatWasThere) {
  const TemporaryFolder folder;
  folder.write("a", "before");
  {
    StagedFile file(folder / "a");
    write(file.path(), "half");
  }
  EXPECT_EQ(folder.read("a"), "before");
  EXPECT_EQ(entriesOf(folder.path()), 1u);
}

TEST(StagedFile, namesWhatCannotBeWritten) {
  const TemporaryFolder folder;
  EXPECT_TRUE(
      contains(errorOf([&] { StagedFile(folder / "none/a"); }), "none/a: cannot be written"));
  EXPECT_TRUE(contains(errorOf([&] { StagedFile file(folder.path()); }), "it is a folder"));
}

TEST(OutputFolder, filesTakeTheirPlaceTogether) {
  const TemporaryFolder folder;
  folder.write("out/a", "before");
  folder.write("out/b", "before");
  folder.write("out/other", "before");
  {
    OutputFolder output(folder / "out");
    write(output.staged("a"), "after");
    EXPECT_EQ(folder.read("out/a"), "before");
    output.commit({"a", "b"});
  }
  EXPECT_EQ(folder.read("out/a"), "after");
  EXPECT_FALSE(fs::exists(folder / "out/b"));  // it was not written: of another map
  EXPECT_EQ(folder.read("out/other"), "before");
  EXPECT_EQ(entriesOf(folder / "out"), 2u);
}

TEST(OutputFolder, withoutCommitIsAsBefore) {
  const TemporaryFolder folder;
  folder.write("out/a", "before");
  {
    OutputFolder output(folder / "out"), created(folder / "new/below");
    write(output.staged("a"), "half");
  }
  EXPECT_EQ(folder.read("out/a"), "before");
  EXPECT_EQ(entriesOf(folder / "out"), 1u);
  EXPECT_FALSE(fs::exists(folder / "new/below"));
}

TEST(OutputFolder, namesAFolderThatCannotBeWritten) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("file", "");
  EXPECT_TRUE(
      contains(errorOf([&] { OutputFolder output(file); }), file.string() + ": cannot write"));
}
