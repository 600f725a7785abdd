#include <gtest/gtest.h>
#include <strict_files/OutputFiles.h>

#include "StagedText.h"
#include "TemporaryFolder.h"

namespace fs = std::filesystem;
using strict_files::OutputFolder;

TEST(OutputFolder, nothingTakesItsPlaceWhereOneOfThemCannot) {
  const TemporaryFolder folder;
  folder.write("a", "before");
  fs::create_directory(folder / "b");
  OutputFolder output(folder.path());
  for (const char* name : {"a", "b"}) write(output.staged(name), "after");
  EXPECT_TRUE(contains(errorOf([&] { output.commit({"a", "b"}); }), "b: cannot be written: it is"));
  EXPECT_EQ(folder.read("a"), "before");
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
