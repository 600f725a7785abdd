#include <gtest/gtest.h>
#include <labeled_cloud/ScanStream.h>

#include <atomic>
#include <stdexcept>

using labeled_cloud::ReadAhead;

TEST(ReadAhead, handsThingsOverInTheirOrder) {
  int made = 0;
  ReadAhead<int> ahead(
      [&]() -> std::optional<int> {
        return made < 1000 ? std::optional<int>(made++) : std::nullopt;
      },
      3);
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(ahead.next(), i);
  EXPECT_FALSE(ahead.next());
  EXPECT_FALSE(ahead.next());
}

TEST(ReadAhead, makesNoMoreThanMayWait) {
  std::atomic<int> made = 0;
  ReadAhead<int> ahead([&] { return std::optional<int>(++made); }, 3);
  for (int taken = 1; taken < 100; ++taken) {
    ahead.next();
    ASSERT_LE(made, taken + 3 + 1);  // one more is in the maker's hands
  }
}

TEST(ReadAhead, throwsWhatTheMakerThrewAfterWhatCameBefore) {
  int made = 0;
  ReadAhead<int> ahead(
      [&]() -> std::optional<int> {
        if (made == 2) throw std::runtime_error("the third");
        return made++;
      },
      10);
  EXPECT_EQ(ahead.next(), 0);
  EXPECT_EQ(ahead.next(), 1);
  EXPECT_THROW(ahead.next(), std::runtime_error);
  EXPECT_FALSE(ahead.next());
}
