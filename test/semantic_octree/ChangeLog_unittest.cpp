#include <semantic_octree/store/ChangeLog.h>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cstdlib>
#include <optional>

using namespace semantic_octree;

namespace {

/** RapidCheck draws the same cases in every run, unless told otherwise. */
const int kSeedOfLogsIsFixed = setenv("RC_PARAMS", "seed=20240517", 0);

using Log = ChangeLog<int>;
constexpr std::size_t kMost = 16;

/** A reader, and what it should know. */
struct LogReader {
  std::optional<Log::Place> place;
  std::vector<int> unread;
  bool hasRead = false;

  void read() {
    if (!place->isLost()) RC_ASSERT(std::vector<int>(place->begin(), place->end()) == unread);
    place->moveToEnd();
    unread.clear();
    hasRead = true;
  }
  void end() {
    place.reset();
    hasRead = false;
  }
};

}  // namespace

TEST(ChangeLog, tellsEachReaderWhatItHasNotReadOrThatItIsLost) {
  EXPECT_TRUE(rc::check([] {
    const auto log = std::make_shared<Log>(kMost);
    LogReader readers[3];
    int next = 0;
    for (const int step : *rc::gen::container<std::vector<int>>(200, rc::gen::inRange(0, 30))) {
      if (step < 3) {
        LogReader& reader = readers[step];
        if (reader.place && next % 7 == 0)
          reader.end();
        else if (reader.place)
          reader.read();
        else
          RC_ASSERT(reader.place.emplace(log).isLost());
      } else {
        log->push(++next);
        for (LogReader& reader : readers) reader.unread.push_back(next);
      }
      RC_ASSERT(log->size() <= kMost);
      for (const LogReader& reader : readers)
        if (reader.hasRead && reader.unread.size() <= kMost / 2) RC_ASSERT(!reader.place->isLost());
    }
  }));
}

TEST(ChangeLog, keepsNothingThatAllHaveRead) {
  const auto log = std::make_shared<Log>(kMost);
  Log::Place quick(log);
  quick.moveToEnd();
  {
    Log::Place slow(log);
    slow.moveToEnd();
    for (int i = 0; i < 5; ++i) log->push(i);
    quick.moveToEnd();
    EXPECT_EQ(log->size(), 5u);
  }
  EXPECT_EQ(log->size(), 0u);
  EXPECT_TRUE(log->isRead());
}

TEST(ChangeLog, aReaderThatLagsDoesNotLoseThePlaceOfAnother) {
  const auto log = std::make_shared<Log>(kMost);
  Log::Place quick(log), slow(log);
  quick.moveToEnd();
  slow.moveToEnd();
  for (int i = 0; i < 100; ++i) {
    log->push(i);
    ASSERT_FALSE(quick.isLost());
    ASSERT_EQ(*quick.begin(), i);
    quick.moveToEnd();
  }
  EXPECT_TRUE(slow.isLost());
  EXPECT_EQ(log->size(), 0u);
}
