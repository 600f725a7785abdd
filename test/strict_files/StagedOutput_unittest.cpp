#include <fcntl.h>
#include <gtest/gtest.h>
#include <strict_files/OutputFiles.h>
#include <strict_files/TextFile.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "FullDisk.h"
#include "TemporaryFolder.h"

namespace {

using OutputFolders = FolderTest;
using ManyOutputs = FolderTest;
using StagedFiles = FolderTest;

inline void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

inline std::size_t entriesOf(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder),
                                                std::filesystem::directory_iterator()));
}

namespace fs = std::filesystem;
using strict_files::OutputFolder;
using strict_files::StagedFile;

/** Forks; the child ends with the action's result. */
template <class Action>
pid_t inChild(Action action) {
  const pid_t child = fork();
  if (child == 0) _exit(action());
  return child;
}

int statusOf(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::vector<std::string> callsToDisk;
useconds_t pauseAfterRename = 0;  ///< microseconds

}  // namespace

// The libraries call these two of ours.
extern "C" int fsync(int descriptor) {
  callsToDisk.push_back("sync " +
                        fs::read_symlink("/proc/self/fd/" + std::to_string(descriptor)).string());
  return static_cast<int>(syscall(SYS_fsync, descriptor));
}
extern "C" int rename(const char* from, const char* to) noexcept {
  callsToDisk.push_back(std::string("rename ") + from);
  const auto result = static_cast<int>(syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
  usleep(pauseAfterRename);
  return result;
}

TEST_F(StagedFiles, withoutCommitLeavesWhatWasThere) {
  folder.write("a", "before");
  {
    StagedFile file(folder / "a");
    write(file.path(), "half");
  }
  EXPECT_EQ(folder.read("a"), "before");
  EXPECT_EQ(entriesOf(folder.path()), 1u);
}

TEST_F(StagedFiles, namesWhatCannotBeWritten) {
  EXPECT_TRUE(
      contains(errorOf([&] { StagedFile(folder / "none/a"); }), "none/a: cannot be written"));
  EXPECT_TRUE(contains(errorOf([&] { StagedFile file(folder.path()); }), "it is a folder"));
}

TEST_F(StagedFiles, processesThatWriteOneFileAtOnceLeaveItWholeAndNothingElse) {
  constexpr std::size_t kLength = 200000;
  std::vector<pid_t> writers;
  for (const char letter : {'a', 'b', 'c', 'd'})
    writers.push_back(inChild([&] {
      for (int i = 0; i < 20; ++i) {
        StagedFile file(folder / "x.txt");
        if (file.path().extension() != ".txt") return 1;  // some writers take the format from it
        write(file.path(), std::string(kLength, letter));
        file.commit();
      }
      return 0;
    }));
  for (const pid_t writer : writers) EXPECT_EQ(statusOf(writer), 0);
  const std::string text = folder.read("x.txt");
  EXPECT_EQ(text, std::string(kLength, text.at(0)));
  EXPECT_EQ(entriesOf(folder.path()), 1u);
}

TEST_F(StagedFiles, leavesWhatIsTheUsersOwn) {
  for (const char* name : {"a.tmp", ".unfinished-notes", ".unfinished-", ".unfinished-a_c123"})
    folder.write(name, "mine");
  fs::create_symlink(folder / "a.tmp", folder / ".unfinished-abc123");
  StagedFile file(folder / "a");
  write(file.path(), "text");
  file.commit();
  EXPECT_EQ(entriesOf(folder.path()), 6u);
  EXPECT_EQ(folder.read("a.tmp"), "mine");
}

TEST_F(StagedFiles, nothingButARegularFileIsReplaced) {
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  fs::create_symlink("nowhere", folder / "dangling");
  for (const std::string name : {"/dev/null", "/dev/full"}) {
    if (!fs::exists(name)) continue;
    fs::create_symlink(name, folder / "device");
    EXPECT_TRUE(contains(errorOf([&] { StagedFile file(name); }), name +
                                                                      ": cannot be written, it is"
                                                                      " no regular file"));
    EXPECT_TRUE(contains(errorOf([&] { StagedFile file(folder / "device"); }), "no regular file"));
    fs::remove(folder / "device");
  }
  EXPECT_TRUE(contains(errorOf([&] { StagedFile file(folder / "pipe"); }), "no regular file"));
  EXPECT_TRUE(contains(errorOf([&] { StagedFile file(folder / "dangling"); }), "leads nowhere"));
  EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
}

TEST_F(StagedFiles, aLinkStaysAndWhatItLeadsToIsReplaced) {
  folder.write("elsewhere/a", "before");
  fs::create_symlink("elsewhere/a", folder / "link");
  {
    StagedFile file(folder / "link");
    write(file.path(), "after");
    file.commit();
  }
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(folder.read("elsewhere/a"), "after");
}

TEST_F(StagedFiles, keepsThePermissionsOfWhatItReplaces) {
  fs::permissions(folder.write("a", "secret"), fs::perms::owner_read | fs::perms::owner_write);
  StagedFile file(folder / "a"), other(folder / "b");
  EXPECT_EQ(fs::status(file.path()).permissions(), fs::status(folder / "a").permissions());
  EXPECT_NE(fs::status(other.path()).permissions(), fs::status(folder / "a").permissions());
}

TEST_F(StagedFiles, isOnTheDiskBeforeItTakesItsName) {
  StagedFile file(folder / "a");
  write(file.path(), "text");
  const std::string staged = file.path();
  callsToDisk.clear();
  file.commit();
  EXPECT_EQ(callsToDisk, (std::vector<std::string>{"sync " + staged, "rename " + staged,
                                                   "sync " + folder.path().string()}));
}

TEST_F(StagedFiles, ofAFullDiskIsNotThere) {
  const std::string error = errorOf([&] {
    const FullDisk full(10);
    strict_files::writeText(folder / "a", "more than ten bytes");
  });
  EXPECT_EQ(error, path("a") + ": cannot be written: File too large");
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST_F(ManyOutputs, ofAProcessThatWasKilledAreRemovedByTheNext) {
  const pid_t killed = inChild([&] {
    const OutputFolder output(folder.path());
    const StagedFile file(folder / "a");
    write(output.staged("b"), "half");
    raise(SIGKILL);
    return 0;
  });
  EXPECT_EQ(statusOf(killed), 128 + SIGKILL);
  EXPECT_EQ(entriesOf(folder.path()), 2u);
  { StagedFile file(folder / "other"); }
  EXPECT_EQ(entriesOf(folder.path()), 0u);
}

TEST_F(ManyOutputs, ofProcessesThatLiveAreNotTouched) {
  const OutputFolder output(folder.path());
  const StagedFile file(folder / "a");
  write(output.staged("b"), "half");
  EXPECT_EQ(statusOf(inChild([&] {
              { OutputFolder(folder / "."), StagedFile(folder / "./a"); }  // it looks again
              return entriesOf(folder.path()) == 2 ? 0 : 1;
            })),
            0);
  EXPECT_EQ(entriesOf(folder.path()), 2u);
  EXPECT_TRUE(fs::exists(output.staged("b")));
}

TEST_F(ManyOutputs, areGoneWhenAProcessLeavesWithoutThem) {
  folder.write("a", "before");
  EXPECT_EQ(statusOf(inChild([&]() -> int {
              const OutputFolder output(folder / "out"), again(folder.path());
              const StagedFile file(folder / "a");
              write(output.staged("b"), "half");
              strict_files::leaveWithoutOutputs(5);
            })),
            5);
  EXPECT_EQ(entriesOf(folder.path()), 1u);
  EXPECT_EQ(folder.read("a"), "before");
}

TEST_F(OutputFolders, goWhereNoMoreFilesCanBeOpened) {
  std::optional<OutputFolder> output(std::in_place, folder / "out");
  write(output->staged("a"), "text");
  const int next = open("/dev/null", O_RDONLY | O_CLOEXEC);
  close(next);
  rlimit before = {};
  getrlimit(RLIMIT_NOFILE, &before);
  const rlimit none = {static_cast<rlim_t>(next), before.rlim_max};
  setrlimit(RLIMIT_NOFILE, &none);
  output.reset();
  setrlimit(RLIMIT_NOFILE, &before);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST_F(OutputFolders, filesAreOnTheDiskBeforeAnyTakesItsPlace) {
  OutputFolder output(folder.path());
  for (const char* name : {"a", "b"}) write(output.staged(name), "text");
  callsToDisk.clear();
  output.commit({"a", "b"});
  ASSERT_EQ(callsToDisk.size(), 5u);
  EXPECT_EQ(callsToDisk[1], "sync " + output.staged("b").string());
  EXPECT_EQ(callsToDisk[2], "rename " + output.staged("a").string());
  EXPECT_EQ(callsToDisk[4], "sync " + folder.path().string());
}

TEST_F(OutputFolders, ofTwoProcessesAtOnceTheFilesAreOfOne) {
  const std::vector<std::string> names = {"a", "b", "c"};
  const auto commitIn = [&](const std::string& text, useconds_t wait, useconds_t slowness) {
    return inChild([&] {
      OutputFolder output(folder.path());
      for (const std::string& name : names) write(output.staged(name), text);
      usleep(wait);
      pauseAfterRename = slowness;
      output.commit(names);
      return 0;
    });
  };
  const pid_t slow = commitIn("slow", 0, 200000), fast = commitIn("fast", 300000, 0);
  EXPECT_EQ(statusOf(slow), 0);
  EXPECT_EQ(statusOf(fast), 0);
  for (const std::string& name : names) EXPECT_EQ(folder.read(name), "fast") << name;
  EXPECT_EQ(entriesOf(folder.path()), names.size());
}

TEST_F(StagedFiles, mayComeToTheDiskLater) {
  strict_files::StagedFile file(folder / "later.txt");
  std::ofstream(file.path()) << "content";
  file.commit(strict_files::StagedFile::Disk::Later);
  EXPECT_EQ(folder.read("later.txt"), "content");
}

TEST_F(OutputFolders, nothingTakesItsPlaceWhereOneOfThemCannot) {
  folder.write("a", "before");
  fs::create_directory(folder / "b");
  OutputFolder output(folder.path());
  for (const char* name : {"a", "b"}) write(output.staged(name), "after");
  EXPECT_TRUE(contains(errorOf([&] { output.commit({"a", "b"}); }), "b: cannot be written: it is"));
  EXPECT_EQ(folder.read("a"), "before");
}

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

TEST_F(StagedFiles, thatAreToBeNewAreKeptBesideWhatSomebodyElseWrote) {
  strict_files::declareNew(folder / "./a.txt");
  {
    StagedFile file(folder / "a.txt");
    write(file.path(), "ours");
    write(folder / "a.txt", "theirs");
    const std::string error = errorOf([&] { file.commit(); });
    const std::string kept = keptIn(folder.path()).string();
    EXPECT_TRUE(contains(error, "a.txt: cannot be written: somebody else has written it"));
    EXPECT_TRUE(contains(error, "is now " + kept));
    EXPECT_EQ(fs::path(kept).extension(), ".txt");
  }
  EXPECT_EQ(strict_files::readText(keptIn(folder.path())), "ours");
  EXPECT_EQ(folder.read("a.txt"), "theirs");
  fs::remove(folder / "a.txt");
  for (const char* text : {"first", "second"}) strict_files::writeText(folder / "a.txt", text);
  EXPECT_EQ(folder.read("a.txt"), "second") << "its own is replaced";
}

TEST_F(OutputFolders, thatAreToBeNewAreKeptBesideWhatSomebodyElseWrote) {
  for (const char* name : {"a", "b", "c", "d"}) strict_files::declareNew(folder / "out" / name);
  {
    OutputFolder output(folder / "out");
    for (const char* name : {"a", "b", "d"}) write(output.staged(name), "ours");
    for (const char* name : {"b", "c"}) write(folder / "out" / name, "theirs");
    output.commit({"c", "d"});
    EXPECT_EQ(folder.read("out/d"), "ours");
    EXPECT_TRUE(contains(errorOf([&] {
                           output.commit({"a", "b"});
                         }),
                         "b: cannot be written: some"));
  }
  for (const char* name : {"a", "b"})
    EXPECT_EQ(strict_files::readText(keptIn(folder / "out") / name), "ours");
  for (const char* name : {"b", "c"}) EXPECT_EQ(folder.read(std::string("out/") + name), "theirs");
  EXPECT_FALSE(fs::exists(folder / "out/a"));
}

TEST_F(OutputFolders, filesTakeTheirPlaceTogether) {
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

TEST_F(OutputFolders, withoutCommitIsAsBefore) {
  folder.write("out/a", "before");
  {
    OutputFolder output(folder / "out"), created(folder / "new/below");
    write(output.staged("a"), "half");
  }
  EXPECT_EQ(folder.read("out/a"), "before");
  EXPECT_EQ(entriesOf(folder / "out"), 1u);
  EXPECT_FALSE(fs::exists(folder / "new/below"));
}

TEST_F(OutputFolders, namesAFolderThatCannotBeWritten) {
  const fs::path file = folder.write("file", "");
  EXPECT_TRUE(
      contains(errorOf([&] { OutputFolder output(file); }), file.string() + ": cannot write"));
}
